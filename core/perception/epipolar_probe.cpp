// SPDX-License-Identifier: BSD-3-Clause
#include "core/perception/epipolar_probe.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace stereod {

namespace {

constexpr int kMinColumns = 48, kMinRows = 24;
constexpr int kMinTexture = 3;      // [gray levels] mean difference of neighbors, in both directions
constexpr float kMinDeviation = 2;  // [gray levels] of a strip; a covered lens has less
constexpr std::uint32_t kNoCost = 0x7FFFFFFF;  // outside the image
constexpr float kMinCorrelation = 0.8F;        // correlation of a patch with its match

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
  // Multiples of the golden ratio, modulo 1, soon cover every part of the image evenly.
  constexpr std::uint32_t kGolden = 0x9E3779B9;
  const auto tops = static_cast<std::uint64_t>(image_.height - kRows - 2 * far_ - 1);
  const int top = far_ + 1 + static_cast<int>(turn_++ * kGolden * tops >> 32);
  smooth_rows(left, {top, top + kRows}, left_.data());
  smooth_rows(right, {top - reach_, top + kRows + reach_}, right_.data());
  measure_texture();
  const GrayStats from = gray_stats(left_row(0), image_.width, stride_);
  const GrayStats to = gray_stats(right_row(reach_), image_.width, stride_);
  for (int third = 0; third < kPatches; ++third) {
    const int x = best_column(image_.width * third / kPatches, image_.width * (third + 1) / kPatches);
    if (x < 0) continue;
    const auto whole = [&](const ValidityMask& mask, int column, int row) {
      return mask.row(row)[column] != 0 && mask.row(row)[column + kColumns - 1] != 0 &&
             mask.row(row + kRows - 1)[column] != 0 && mask.row(row + kRows - 1)[column + kColumns - 1] != 0;
    };
    if (!whole(left.mask, x, top)) continue;
    Position position{};
    bool absent = false;
    float across = 0, down = 0;
    if (!search(x, from, to, position, absent)) {
      result.absent += absent ? 1 : 0;
      continue;
    }
    const int row = top - reach_ + position.y;
    if (!whole(right.mask, position.x, row) || !refine(x, position, across, down)) continue;
    const auto at = as_size(result.found++);
    matches[at] = {static_cast<float>(x) + kColumns / 2.0F, static_cast<float>(top) + kRows / 2.0F,
                   static_cast<float>(top - row) - down, static_cast<float>(x - position.x) - across};
  }
  return result;
}

// Rectifies rows and smooths them by 1-2-1 in both directions, so that a comparison at whole pixels tolerates
// matches that lie between pixels.
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

EpipolarProbe::GrayStats EpipolarProbe::gray_stats(const std::uint8_t* rows, int width,
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

// Returns the column in [first, end) of the patch with the most texture, measured in the direction in which
// it has less; −1 if none has enough.
int EpipolarProbe::best_column(int first, int end) const noexcept {
  int best = -1;
  int maximum = kMinTexture * kColumns * (kRows - 1) - 1;
  for (int x = first; x + kColumns <= end; x += kColumns / 2) {
    int across = 0, down = 0;
    for (int i = 0; i < kColumns; ++i) across += across_[as_size(x + i)], down += down_[as_size(x + i)];
    const int texture = std::min(across, down);
    if (texture > maximum) maximum = texture, best = x;
  }
  return best;
}

// Copies every second row of the patch at column x, with its gray values adjusted to those of the right strip.
EpipolarProbe::Patch EpipolarProbe::adjusted_patch(int x, const GrayStats& from,
                                                   const GrayStats& to) const noexcept {
  Patch patch{};
  const float gain = to.deviation / from.deviation;
  int mean = 0;
  for (int row = 0; row < kUsedRows; ++row) {
    for (int i = 0; i < kColumns; ++i) {
      const float value = (static_cast<float>(left_row(2 * row)[x + i]) - from.mean) * gain + to.mean;
      patch.gray[row][i] = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
      mean += patch.gray[row][i];
    }
  }
  mean /= kUsedRows * kColumns;
  for (const auto& row : patch.gray) {
    for (const std::uint8_t value : row) patch.contrast += static_cast<std::uint32_t>(std::abs(value - mean));
  }
  return patch;
}

// Writes the sum of absolute differences at each row and column searched to costs_, and returns the minimum.
std::uint32_t EpipolarProbe::minimum_cost(const Patch& patch, int first, int positions,
                                          Position& best) noexcept {
  std::uint32_t minimum = kNoCost;
  for (int line = 0; line < 2 * reach_ + 1; ++line) {
    std::uint32_t* costs = costs_.data() + line * positions;
    for (int position = 0; position < positions; ++position) {
      const std::uint8_t* right = right_row(line) + first + position;
      int cost = 0;
      for (int row = 0; row < kUsedRows; ++row, right += 2 * stride_) {
        for (int i = 0; i < kColumns; ++i) cost += std::abs(patch.gray[row][i] - right[i]);
      }
      costs[position] = static_cast<std::uint32_t>(cost);
      if (costs[position] < minimum) minimum = costs[position], best = {first + position, line};
    }
  }
  return minimum;
}

// Returns the minimum of the costs that lie more than two pixels from `best`.
std::uint32_t EpipolarProbe::rival_cost(int first, int positions, const Position& best) const noexcept {
  std::uint32_t rival = kNoCost;
  for (int line = 0; line < 2 * reach_ + 1; ++line) {
    const std::uint32_t* costs = costs_.data() + line * positions;
    const bool near = std::abs(line - best.y) <= 2;
    for (int position = 0; position < positions; ++position) {
      if (near && std::abs(first + position - best.x) <= 2) continue;
      rival = std::min(rival, costs[position]);
    }
  }
  return rival;
}

// Searches the patch at column x to whole pixels. Returns false if no place is similar (`absent`), or if several
// are.
bool EpipolarProbe::search(int x, const GrayStats& from, const GrayStats& to, Position& best,
                           bool& absent) noexcept {
  absent = to.deviation < kMinDeviation || from.deviation < kMinDeviation;
  if (absent) return false;
  const int first = std::max(0, x - min_disparity_ - disparities_ + 1), last = x - min_disparity_;
  const int positions = last - first + 1;
  if (positions <= 0) return false;
  const Patch patch = adjusted_patch(x, from, to);
  const std::uint32_t minimum = minimum_cost(patch, first, positions, best);
  absent = 2 * minimum > patch.contrast;
  if (absent) return false;
  if (best.y == 0 || best.y == 2 * reach_) {  // the minimum may lie beyond the rows searched
    absent = reach_ == kNear;
    return false;
  }
  const std::uint32_t rival = rival_cost(first, positions, best);
  // Strict, because wrong points do harm and missing ones do not: the match must be clearly similar, clearly
  // better than any other place, and no other place may be even half as similar. This rejects repetitive
  // patterns, also where a copy lies on whole pixels and the true match between them.
  return 20 * minimum < 7 * patch.contrast && 5 * minimum < 4 * rival && 5 * rival > 3 * patch.contrast;
}

// Copies the inner pixels of the patch at column x of the left strip, less their mean, and their gradients.
EpipolarProbe::Gradients EpipolarProbe::gradients_at(int x) const noexcept {
  Gradients g{};
  float mean = 0;
  int n = 0;
  for (int row = 1; row + 1 < kRows; ++row) {
    for (int i = 1; i + 1 < kColumns; ++i, ++n) {
      const std::uint8_t* pixel = left_row(row) + x + i;
      g.value[n] = pixel[0];
      mean += g.value[n] / kInner;
      g.slope_x[n] = static_cast<float>(pixel[1] - pixel[-1]) / 2;
      g.slope_y[n] = static_cast<float>(pixel[stride_] - pixel[-stride_]) / 2;
      g.xx += g.slope_x[n] * g.slope_x[n];
      g.xy += g.slope_x[n] * g.slope_y[n];
      g.yy += g.slope_y[n] * g.slope_y[n];
    }
  }
  for (float& v : g.value) v -= mean, g.deviation += v * v;
  return g;
}

// Samples the right strip between pixels, at `position` + (across, down), less the mean of the samples. Returns
// false if the patch exceeds the strip.
bool EpipolarProbe::sample_right(const Position& position, float across, float down,
                                 float* samples) const noexcept {
  const float fx = std::floor(across), fy = std::floor(down);
  const int column = position.x + static_cast<int>(fx), line = position.y + static_cast<int>(fy);
  if (line < 0 || line + kRows >= kRows + 2 * reach_ || column < 0 || column + kColumns >= image_.width) {
    return false;
  }
  const float u = across - fx, v = down - fy;
  float mean = 0;
  int n = 0;
  for (int row = 1; row + 1 < kRows; ++row) {
    for (int i = 1; i + 1 < kColumns; ++i, ++n) {
      const std::uint8_t* pixel = right_row(line + row) + column + i;
      samples[n] = (1 - v) * ((1 - u) * pixel[0] + u * pixel[1]) +
                   v * ((1 - u) * pixel[stride_] + u * pixel[stride_ + 1]);
      mean += samples[n] / kInner;
    }
  }
  for (int i = 0; i < kInner; ++i) samples[i] -= mean;
  return true;
}

// Refines the match of the patch at column x to fractions of a pixel: (across, down) are added to `position`.
// Returns false if the patch is an edge, the match moves away, or the two are not similar.
bool EpipolarProbe::refine(int x, const Position& position, float& across, float& down) const noexcept {
  const Gradients g = gradients_at(x);
  const float determinant = g.xx * g.yy - g.xy * g.xy;
  if (!(determinant > 0.1F * g.xx * g.yy) || !(g.deviation > 0)) return false;  // an edge, no corner

  float correlation = 0;
  for (int step = 0; step < 4; ++step) {
    float samples[kInner];
    if (!sample_right(position, across, down, samples)) return false;
    float deviation = 0, common = 0;
    for (int i = 0; i < kInner; ++i) {
      deviation += samples[i] * samples[i], common += samples[i] * g.value[i];
    }
    if (!(deviation > 0)) return false;
    correlation = common / std::sqrt(deviation * g.deviation);
    const float scale = std::sqrt(g.deviation / deviation);
    float right = 0, below = 0;
    for (int i = 0; i < kInner; ++i) {
      const float error = scale * samples[i] - g.value[i];
      right += g.slope_x[i] * error, below += g.slope_y[i] * error;
    }
    const float move_x = -(g.yy * right - g.xy * below) / determinant;
    const float move_y = -(g.xx * below - g.xy * right) / determinant;
    if (std::abs(move_x) < 0.02F && std::abs(move_y) < 0.02F) break;
    across += move_x, down += move_y;
    if (!(std::abs(across) < 1.5F && std::abs(down) < 1.5F)) return false;
  }
  return correlation >= kMinCorrelation;
}

}  // namespace stereod
