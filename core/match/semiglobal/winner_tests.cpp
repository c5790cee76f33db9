#include "core/match/semiglobal/winner_tests.h"

#include <algorithm>

namespace stereod::semiglobal {
namespace {

std::size_t size(int value) { return static_cast<std::size_t>(value); }

constexpr int kMostCurvature = 2 * 255;
constexpr int kReciprocalOne = 65536;

}  // namespace

WinnerTests::WinnerTests(const MatcherOptions& options, const Shape& shape, const Kernel& kernel)
    : options_(options),
      shape_(shape),
      kernel_(kernel),
      reciprocals_(kMostCurvature + 1),
      before_(size(shape.disparities)),
      after_(size(shape.disparities)),
      index_(size(shape.grid_width())),
      claims_(size(shape.grid_width())) {
  for (int i = 1; i <= kMostCurvature; ++i) reciprocals_[size(i)] = (kReciprocalOne + i / 2) / i;
  const int last = shape.disparities - 1;
  for (int k = 0; k <= last; ++k) {  // the first and the last have the same one on both sides, so no slope
    const int before = k == 0 ? std::min(1, last) : k - 1;
    const int after = k == last ? std::max(last - 1, 0) : k + 1;
    before_[size(k)] = static_cast<std::uint8_t>(shape.place(before));
    after_[size(k)] = static_cast<std::uint8_t>(shape.place(after));
  }
}

void WinnerTests::write(const std::uint8_t* sums, const std::uint16_t* winners, const std::uint8_t* left_mask,
                        const std::uint8_t* right_mask, GridValue* out) noexcept {
  interpolate(sums, winners, out);
  if (options_.left_right_max_diff >= 0) reject_contested(out);
  if (options_.uniqueness_ratio > 0) reject_ambiguous(sums, winners, out);
  if (left_mask != nullptr || right_mask != nullptr) reject_masked(left_mask, right_mask, out);
}

void WinnerTests::interpolate(const std::uint8_t* sums, const std::uint16_t* winners,
                              GridValue* out) noexcept {
  switch (shape_.vectors) {  // as constants, two to four make it a third shorter
    case 2:
      return interpolate_among<2>(sums, winners, out);
    case 4:
      return interpolate_among<4>(sums, winners, out);
    default:
      return interpolate_among<0>(sums, winners, out);
  }
}

// Also notes which right points are claimed, and leaves out winners outside the right picture.
template <int kVectors>
void WinnerTests::interpolate_among(const std::uint8_t* sums, const std::uint16_t* winners,
                                    GridValue* out) noexcept {
  const int width = shape_.grid_width();
  const int vectors = kVectors > 0 ? kVectors : shape_.vectors;
  const std::ptrdiff_t lanes = shape_.lanes;
  const int shift = shape_.column_step == 2 ? 1 : 0;
  const int min_disparity = shape_.min_disparity;
  const std::ptrdiff_t point_bytes = shape_.point_bytes();
  const std::uint8_t* const before = before_.data();
  const std::uint8_t* const after = after_.data();
  const std::int32_t* const reciprocals = reciprocals_.data();
  std::uint8_t* const index = index_.data();
  std::uint16_t* const claims = claims_.data();
  std::fill_n(claims, width, std::uint16_t{0xFFFF});
  const std::uint8_t* point = sums;
  for (std::ptrdiff_t x = 0; x < width; ++x, point += point_bytes) {
    const unsigned lane = winners[x] & 0xFFU;
    const unsigned least = winners[x] >> 8;
    unsigned k = lane * static_cast<unsigned>(vectors);
    unsigned searching = 1;  // without a branch: which vector it is, is hard to foretell
    const std::uint8_t* place = point + lane;
#pragma GCC unroll 4
    for (int vector = 0; vector + 1 < vectors; ++vector, place += lanes) {
      searching &= *place != least ? 1U : 0U;
      k += searching;
    }
    const int b = point[before[k]];
    const int a = point[after[k]];
    const auto doubled = static_cast<int>(2 * least);
    const int part = (8 * (b - a) * reciprocals[b + a - doubled] + kReciprocalOne / 2) >> 16;
    const auto whole = static_cast<int>(k);
    index[x] = static_cast<std::uint8_t>(k);
    const int match = (static_cast<int>(x) << shift) - min_disparity - whole;
    out[x] = match < 0 ? kNone : static_cast<GridValue>(2 * (16 * whole + part));
    if (match < 0) continue;
    std::uint16_t& standing = claims[static_cast<unsigned>(match) >> shift];
    const auto claim = static_cast<std::uint16_t>(least << 8 | k);
    standing = claim < standing ? claim : standing;
  }
}

void WinnerTests::reject_contested(GridValue* out) const noexcept {
  const int width = shape_.grid_width();
  const int shift = shape_.column_step == 2 ? 1 : 0;
  const auto max_diff = static_cast<unsigned>(options_.left_right_max_diff);
  const std::uint8_t* const index = index_.data();
  const std::uint16_t* const claims = claims_.data();
  for (int x = 0; x < width; ++x) {
    const int match = (x << shift) - shape_.min_disparity - index[x];
    const int standing = claims[std::max(match, 0) >> shift] & 0xFF;
    // |difference| > max_diff, in one comparison; kNone has all bits set.
    const bool differs = static_cast<unsigned>(standing - index[x]) + max_diff > 2 * max_diff;
    out[x] = static_cast<GridValue>(out[x] | -static_cast<int>(differs));
  }
}

void WinnerTests::reject_ambiguous(const std::uint8_t* sums, const std::uint16_t* winners,
                                   GridValue* out) const noexcept {
  constexpr int kMost = 255;
  const int padding = shape_.point_bytes() - shape_.disparities;  // they have the greatest sum there is
  const int last = shape_.disparities - 1;
  for (int x = 0; x < shape_.grid_width(); ++x, sums += shape_.point_bytes()) {
    const int least = winners[x] >> 8;
    const int limit = least + least * options_.uniqueness_ratio / 100;
    const int k = index_[size(x)];
    int rivals = kernel_.count_at_most(shape_, sums, std::min(limit, kMost));
    if (limit >= kMost) rivals -= padding;
    for (int beside = std::max(k - 1, 0); beside <= std::min(k + 1, last); ++beside) {
      rivals -= sums[shape_.place(beside)] <= limit ? 1 : 0;
    }
    if (rivals > 0) out[x] = kNone;
  }
}

void WinnerTests::reject_masked(const std::uint8_t* left_mask, const std::uint8_t* right_mask,
                                GridValue* out) const noexcept {
  for (int x = 0; x < shape_.grid_width(); ++x) {
    if (out[x] < 0) continue;
    const int column = x * shape_.column_step;
    const bool left = left_mask == nullptr || left_mask[column] != 0;
    const bool right =
        right_mask == nullptr || right_mask[column - shape_.min_disparity - index_[size(x)]] != 0;
    if (!left || !right) out[x] = kNone;
  }
}

std::size_t WinnerTests::scratch_bytes() const noexcept {
  return reciprocals_.size() * sizeof(reciprocals_[0]) + before_.size() + after_.size() + index_.size() +
         claims_.size() * sizeof(claims_[0]);
}

}  // namespace stereod::semiglobal
