#include "core/perception/epipolar_probe.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace stereod {

namespace {

constexpr int kMinColumns = 48, kMinRows = 24;
constexpr int kMinTexture = 3;      // mean difference of neighbors in either direction, gray levels
constexpr float kMinDeviation = 2;  // of a strip's brightness; less is a covered lens
constexpr std::uint32_t kNoCost = 0x7FFFFFFF;  // beyond the image
constexpr float kMinLikeness = 0.8F;           // correlation of the patch with what was found

template <typename T>
std::size_t as_size(T value) {
  return static_cast<std::size_t>(value);
}

}  // namespace

EpipolarProbe::EpipolarProbe(Size image, int min_disparity, int disparities)
    : image_(image),
      min_disparity_(min_disparity),
      disparities_(disparities),
      far_(std::clamp(image.height / 20, 4, 24)),
      reach_(far_),
      stride_((image.width + 127) / 64 * 64) {
  if (image_.width < kMinColumns || image_.height < kMinRows) return;
  left_ = AlignedBuffer<std::uint8_t>(as_size(stride_ * kRows));
  right_ = AlignedBuffer<std::uint8_t>(as_size(stride_ * (kRows + 2 * far_)));
  rectified_ = AlignedBuffer<std::uint8_t>(as_size(3 * stride_));
  sums_ = AlignedBuffer<std::uint16_t>(as_size(stride_));
  across_ = AlignedBuffer<std::uint16_t>(as_size(stride_));
  down_ = AlignedBuffer<std::uint16_t>(as_size(stride_));
  costs_ = AlignedBuffer<std::uint32_t>(as_size((2 * far_ + 1) * disparities_));
}

EpipolarProbe::Result EpipolarProbe::probe(const ProbedFrame& left, const ProbedFrame& right, Reach reach,
                                           std::span<EpipolarMatch, kPatches> matches) noexcept {
  Result result;
  if (left_.size() == 0) return result;
  reach_ = reach == Reach::kNear ? kNear : far_;
  // Multiples of the golden ratio, as parts of a whole, cover every part of the image soon and evenly.
  constexpr std::uint32_t kGolden = 0x9E3779B9;
  const auto tops = static_cast<std::uint64_t>(image_.height - kRows - 2 * far_ - 1);
  const int top = far_ + 1 + static_cast<int>(turn_++ * kGolden * tops >> 32);
  smooth_rows(left, {top, top + kRows}, left_.data());
  smooth_rows(right, {top - reach_, top + kRows + reach_}, right_.data());
  measure_texture();
  const Tone from = tone_of(left_row(0), image_.width, stride_);
  const Tone to = tone_of(right_row(reach_), image_.width, stride_);
  for (int third = 0; third < kPatches; ++third) {
    const int x = best_column(image_.width * third / kPatches, image_.width * (third + 1) / kPatches);
    if (x < 0) continue;
    const auto whole = [&](const ValidityMask& mask, int column, int row) {
      return mask.row(row)[column] != 0 && mask.row(row)[column + kColumns - 1] != 0 &&
             mask.row(row + kRows - 1)[column] != 0 && mask.row(row + kRows - 1)[column + kColumns - 1] != 0;
    };
    if (!whole(left.mask, x, top)) continue;
    Place place{};
    bool absent = false;
    float across = 0, down = 0;
    if (!search(x, from, to, place, absent)) {
      result.absent += absent ? 1 : 0;
      continue;
    }
    const int row = top - reach_ + place.y;
    if (!whole(right.mask, place.x, row) || !refine(x, place, across, down)) continue;
    const auto at = as_size(result.found++);
    matches[at] = {static_cast<float>(x) + kColumns / 2.0F, static_cast<float>(top) + kRows / 2.0F,
                   static_cast<float>(top - row) - down, static_cast<float>(x - place.x) - across};
  }
  return result;
}

// Rectifies rows and smooths them by 1-2-1 both ways, so that it does not matter much to a comparison by
// whole pixels that what is alike lies between them.
void EpipolarProbe::smooth_rows(const ProbedFrame& frame, RowRange rows, std::uint8_t* out) noexcept {
  const int width = image_.width;
  const auto ring = [&](int y) { return rectified_.data() + (y % 3) * stride_; };
  frame.map.gray_row(frame.source, rows.first - 1, ring(rows.first - 1));
  frame.map.gray_row(frame.source, rows.first, ring(rows.first));
  for (int y = rows.first; y < rows.end; ++y, out += stride_) {
    frame.map.gray_row(frame.source, y + 1, ring(y + 1));
    const std::uint8_t* __restrict above = ring(y - 1);
    const std::uint8_t* __restrict here = ring(y);
    const std::uint8_t* __restrict below = ring(y + 1);
    std::uint16_t* __restrict sums = sums_.data();
    std::uint8_t* __restrict to = out;
    for (int x = 0; x < width; ++x) sums[x] = static_cast<std::uint16_t>(above[x] + 2 * here[x] + below[x]);
    to[0] = static_cast<std::uint8_t>(sums[0] / 4);
    for (int x = 1; x + 1 < width; ++x) {
      to[x] = static_cast<std::uint8_t>((sums[x - 1] + 2 * sums[x] + sums[x + 1] + 8) >> 4);
    }
    to[width - 1] = static_cast<std::uint8_t>(sums[width - 1] / 4);
  }
}

EpipolarProbe::Tone EpipolarProbe::tone_of(const std::uint8_t* rows, int width,
                                           std::ptrdiff_t stride) noexcept {
  int count = 0;
  std::int64_t sum = 0, squares = 0;
  for (int row = 0; row < kRows; row += 2) {
    for (int x = 0; x < width; x += 4) {
      const int value = rows[row * stride + x];
      sum += value, squares += value * value, ++count;
    }
  }
  const float mean = static_cast<float>(sum) / static_cast<float>(count);
  const float variance = static_cast<float>(squares) / static_cast<float>(count) - mean * mean;
  return {mean, std::sqrt(std::max(variance, 0.0F))};
}

void EpipolarProbe::measure_texture() noexcept {
  std::uint16_t* __restrict across = across_.data();
  std::uint16_t* __restrict down = down_.data();
  const int width = image_.width;
  across_.fill_zero();
  down_.fill_zero();
  for (int row = 0; row + 1 < kRows; ++row) {
    const std::uint8_t* __restrict here = left_row(row);
    const std::uint8_t* __restrict below = left_row(row + 1);
    for (int x = 0; x + 1 < width; ++x) {
      across[x] = static_cast<std::uint16_t>(across[x] + std::abs(here[x + 1] - here[x]));
      down[x] = static_cast<std::uint16_t>(down[x] + std::abs(below[x] - here[x]));
    }
  }
}

// Where, in [first, end), a patch has most texture in that direction in which it has less; -1: nowhere
// enough.
int EpipolarProbe::best_column(int first, int end) const noexcept {
  int best = -1;
  int most = kMinTexture * kColumns * (kRows - 1) - 1;
  for (int x = first; x + kColumns <= end; x += kColumns / 2) {
    int across = 0, down = 0;
    for (int i = 0; i < kColumns; ++i) across += across_[as_size(x + i)], down += down_[as_size(x + i)];
    const int texture = std::min(across, down);
    if (texture > most) most = texture, best = x;
  }
  return best;
}

// To a pixel, by the sum of absolute differences over every second row of the patch, whose tone is adjusted
// to the right image's. False if nothing is alike (absent), or something else is nearly as much.
bool EpipolarProbe::search(int x, const Tone& from, const Tone& to, Place& best, bool& absent) noexcept {
  absent = to.deviation < kMinDeviation || from.deviation < kMinDeviation;
  if (absent) return false;
  constexpr int kUsed = kRows / 2;
  std::uint8_t patch[kUsed][kColumns];
  const float gain = to.deviation / from.deviation;
  int contrast = 0;  // what the patch differs from plain gray
  for (int row = 0; row < kUsed; ++row) {
    for (int i = 0; i < kColumns; ++i) {
      const float value = (static_cast<float>(left_row(2 * row)[x + i]) - from.mean) * gain + to.mean;
      patch[row][i] = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    }
  }
  int mean = 0;
  for (const auto& row : patch) {
    for (const std::uint8_t value : row) mean += value;
  }
  mean /= kUsed * kColumns;
  for (const auto& row : patch) {
    for (const std::uint8_t value : row) contrast += std::abs(value - mean);
  }

  const int first = std::max(0, x - min_disparity_ - disparities_ + 1), last = x - min_disparity_;
  const int lines = 2 * reach_ + 1, places = last - first + 1;
  if (places <= 0) return false;
  std::uint32_t least = kNoCost;
  for (int line = 0; line < lines; ++line) {
    std::uint32_t* costs = costs_.data() + line * places;
    for (int place = 0; place < places; ++place) {
      const std::uint8_t* right = right_row(line) + first + place;
      int cost = 0;
      for (int row = 0; row < kUsed; ++row, right += 2 * stride_) {
        for (int i = 0; i < kColumns; ++i) cost += std::abs(patch[row][i] - right[i]);
      }
      costs[place] = static_cast<std::uint32_t>(cost);
      if (costs[place] < least) least = costs[place], best = {first + place, line};
    }
  }
  absent = 2 * least > static_cast<std::uint32_t>(contrast);
  if (absent) return false;
  if (best.y == 0 || best.y == lines - 1) {  // it may lie beyond
    absent = reach_ == kNear;
    return false;
  }
  std::uint32_t rival = kNoCost;
  for (int line = 0; line < lines; ++line) {
    const std::uint32_t* costs = costs_.data() + line * places;
    const bool near = std::abs(line - best.y) <= 2;
    for (int place = 0; place < places; ++place) {
      if (near && std::abs(first + place - best.x) <= 2) continue;
      rival = std::min(rival, costs[place]);
    }
  }
  // Strict, because wrong points do harm and missing ones do not: clearly alike, clearly better than anything
  // else, and nothing else even half alike. Patterns that repeat themselves are left alone that way, also
  // where a copy happens to lie on whole pixels and the thing itself between them.
  const auto plain = static_cast<std::uint32_t>(contrast);
  return 20 * least < 7 * plain && 5 * least < 4 * rival && 5 * rival > 3 * plain;
}

bool EpipolarProbe::refine(int x, const Place& place, float& across, float& down) const noexcept {
  constexpr int kInner = (kColumns - 2) * (kRows - 2);
  float value[kInner], slope_x[kInner], slope_y[kInner];
  float xx = 0, xy = 0, yy = 0, mean = 0;
  int n = 0;
  for (int row = 1; row + 1 < kRows; ++row) {
    for (int i = 1; i + 1 < kColumns; ++i, ++n) {
      const std::uint8_t* at = left_row(row) + x + i;
      value[n] = at[0];
      mean += value[n] / kInner;
      slope_x[n] = static_cast<float>(at[1] - at[-1]) / 2;
      slope_y[n] = static_cast<float>(at[stride_] - at[-stride_]) / 2;
      xx += slope_x[n] * slope_x[n], xy += slope_x[n] * slope_y[n], yy += slope_y[n] * slope_y[n];
    }
  }
  float deviation = 0;
  for (float& v : value) v -= mean, deviation += v * v;
  const float determinant = xx * yy - xy * xy;
  if (!(determinant > 0.1F * xx * yy) || !(deviation > 0)) return false;  // an edge, not a corner

  float likeness = 0;
  for (int step = 0; step < 4; ++step) {
    // The right image there, between pixels.
    const float fx = std::floor(across), fy = std::floor(down);
    const int column = place.x + static_cast<int>(fx), line = place.y + static_cast<int>(fy);
    if (line < 0 || line + kRows >= kRows + 2 * reach_ || column < 0 || column + kColumns >= image_.width)
      return false;
    const float u = across - fx, v = down - fy;
    float found[kInner];
    float found_mean = 0;
    n = 0;
    for (int row = 1; row + 1 < kRows; ++row) {
      for (int i = 1; i + 1 < kColumns; ++i, ++n) {
        const std::uint8_t* at = right_row(line + row) + column + i;
        found[n] =
            (1 - v) * ((1 - u) * at[0] + u * at[1]) + v * ((1 - u) * at[stride_] + u * at[stride_ + 1]);
        found_mean += found[n] / kInner;
      }
    }
    float found_deviation = 0, common = 0;
    for (int i = 0; i < kInner; ++i) {
      found[i] -= found_mean;
      found_deviation += found[i] * found[i], common += found[i] * value[i];
    }
    if (!(found_deviation > 0)) return false;
    likeness = common / std::sqrt(found_deviation * deviation);
    const float scale = std::sqrt(deviation / found_deviation);
    float right = 0, below = 0;
    for (int i = 0; i < kInner; ++i) {
      const float error = scale * found[i] - value[i];
      right += slope_x[i] * error, below += slope_y[i] * error;
    }
    const float move_x = -(yy * right - xy * below) / determinant,
                move_y = -(xx * below - xy * right) / determinant;
    if (std::abs(move_x) < 0.02F && std::abs(move_y) < 0.02F) break;
    across += move_x, down += move_y;
    if (!(std::abs(across) < 1.5F && std::abs(down) < 1.5F)) return false;
  }
  return likeness >= kMinLikeness;
}

}  // namespace stereod
