#include "core/match/semiglobal/disparity_checks.h"

#include <algorithm>

#include "core/base/simd_i16x8.h"

namespace stereod::semiglobal {
namespace {

constexpr int kMax = 255;  // a sum

std::size_t size(int value) { return static_cast<std::size_t>(value); }

}  // namespace

DisparityChecks::DisparityChecks(const MatcherOptions& options, const Shape& shape, const Kernel& kernel)
    : options_(options),
      shape_(shape),
      kernel_(kernel),
      before_(size(shape.disparities)),
      after_(size(shape.disparities)),
      index_(size(shape.grid_width() + kValueMargin)),
      sum_before_(index_.size()),
      sum_after_(index_.size()),
      claimed_or_count_(index_.size()),
      standing_or_limit_(index_.size()),
      claims_(index_.size()),
      limit_of_(kMax + 1) {
  for (int least = 0; least <= kMax; ++least) {
    const int limit = least + least * options.uniqueness_ratio / 100;
    limit_of_[size(least)] = static_cast<std::uint8_t>(std::min(limit, kMax));
  }
  const int last = shape.disparities - 1;
  for (int k = 0; k <= last; ++k) {  // the first and the last have the same one on both sides, so no slope
    const int before = k == 0 ? std::min(1, last) : k - 1;
    const int after = k == last ? std::max(last - 1, 0) : k + 1;
    before_[size(k)] = static_cast<std::uint8_t>(shape.place(before));
    after_[size(k)] = static_cast<std::uint8_t>(shape.place(after));
  }
}

void DisparityChecks::write(const std::uint8_t* sums, const std::uint16_t* winners,
                            const std::uint8_t* left_mask, const std::uint8_t* right_mask,
                            GridValue* out) noexcept {
  find_winners(sums, winners);
  kernel_.interpolate_row(shape_, {winners, index_.data(), sum_before_.data(), sum_after_.data()}, out);
  if (options_.left_right_max_diff >= 0) reject_contested(out);
  if (options_.uniqueness_ratio > 0) reject_ambiguous(sums, winners, out);
  if (left_mask != nullptr || right_mask != nullptr) reject_masked(left_mask, right_mask, out);
}

void DisparityChecks::find_winners(const std::uint8_t* sums, const std::uint16_t* winners) noexcept {
  switch (shape_.vectors) {  // as constants, two to four make it a third shorter
    case 2:
      return find_winners_among<2>(sums, winners);
    case 4:
      return find_winners_among<4>(sums, winners);
    default:
      return find_winners_among<0>(sums, winners);
  }
}

// What has to be looked up point by point, and which right points are claimed.
template <int kVectors>
void DisparityChecks::find_winners_among(const std::uint8_t* sums, const std::uint16_t* winners) noexcept {
  const int width = shape_.grid_width();
  const int vectors = kVectors > 0 ? kVectors : shape_.vectors;
  const std::ptrdiff_t lanes = shape_.lanes;
  const int shift = column_shift();
  const std::ptrdiff_t point_bytes = shape_.point_bytes();
  const std::uint8_t* const before = before_.data();
  const std::uint8_t* const after = after_.data();
  std::uint8_t* const index = index_.data();
  std::uint8_t* const sum_before = sum_before_.data();
  std::uint8_t* const sum_after = sum_after_.data();
  std::int16_t* const claimed = claimed_or_count_.data();
  std::uint16_t* const claims = claims_.data();
  std::fill_n(claims, width, std::uint16_t{0xFFFF});
  const std::uint8_t* point = sums;
  int column = -shape_.min_disparity;
  for (std::ptrdiff_t x = 0; x < width; ++x, point += point_bytes, column += 1 << shift) {
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
    index[x] = static_cast<std::uint8_t>(k);
    sum_before[x] = point[before[k]];
    sum_after[x] = point[after[k]];
    const int match = column - static_cast<int>(k);
    claimed[x] = 0;
    if (match < 0) continue;
    claimed[x] = static_cast<std::int16_t>(match >> shift);
    std::uint16_t& standing = claims[claimed[x]];
    const auto claim = static_cast<std::uint16_t>(least << 8 | k);
    standing = claim < standing ? claim : standing;
  }
}

void DisparityChecks::reject_contested(GridValue* out) noexcept {
  const int width = shape_.grid_width();
  const std::uint8_t* const index = index_.data();
  const std::int16_t* const claimed = claimed_or_count_.data();
  const std::uint16_t* const claims = claims_.data();
  std::uint8_t* const standing = standing_or_limit_.data();
#pragma GCC unroll 4
  for (std::ptrdiff_t x = 0; x < width; ++x) standing[x] = static_cast<std::uint8_t>(claims[claimed[x]]);
  const auto max_diff = static_cast<std::int16_t>(options_.left_right_max_diff);
  for (int x = 0; x < width; x += kI16Lanes) {
    const I16x8 difference = load_i16x8(standing + x) - load_i16x8(index + x);
    store_i16x8(out + x, load_i16x8(out + x) | (difference > max_diff) | (-difference > max_diff));
  }
}

// Rivals are sums at most so much above the least one, other than that and those beside it.
void DisparityChecks::reject_ambiguous(const std::uint8_t* sums, const std::uint16_t* winners,
                                       GridValue* out) noexcept {
  const int width = shape_.grid_width();
  const std::uint8_t* const limit_of = limit_of_.data();
  std::uint8_t* const limits = standing_or_limit_.data();
#pragma GCC unroll 4
  for (std::ptrdiff_t x = 0; x < width; ++x) limits[x] = limit_of[winners[x] >> 8];
  kernel_.count_at_most(shape_, sums, standing_or_limit_.data(), claimed_or_count_.data());
  const auto padding =
      static_cast<std::int16_t>(shape_.point_bytes() - shape_.disparities);  // all the greatest sum
  const auto last = static_cast<std::int16_t>(shape_.disparities - 1);
  for (int x = 0; x < width; x += kI16Lanes) {
    const I16x8 limit = load_i16x8(standing_or_limit_.data() + x), k = load_i16x8(index_.data() + x);
    // −1 where they are among those counted; at the ends it is one and the same.
    const I16x8 before = load_i16x8(sum_before_.data() + x) <= limit;
    const I16x8 after = (load_i16x8(sum_after_.data() + x) <= limit) & (k != 0) & (k != last);
    const I16x8 counted = load_i16x8(claimed_or_count_.data() + x) - ((limit == kMax) & padding);
    store_i16x8(out + x, load_i16x8(out + x) | (counted - 1 + before + after > I16x8{}));
  }
}

void DisparityChecks::reject_masked(const std::uint8_t* left_mask, const std::uint8_t* right_mask,
                                    GridValue* out) const noexcept {
  for (int x = 0; x < shape_.grid_width(); ++x) {
    if (out[x] < 0) continue;
    const int column = x * shape_.decimation_x;
    const bool left = left_mask == nullptr || left_mask[column] != 0;
    const bool right =
        right_mask == nullptr || right_mask[column - shape_.min_disparity - index_[size(x)]] != 0;
    if (!left || !right) out[x] = kNone;
  }
}

std::size_t DisparityChecks::scratch_bytes() const noexcept {
  return before_.size() + after_.size() + 3 * index_.size() + standing_or_limit_.size() + limit_of_.size() +
         claimed_or_count_.size() * (sizeof(claimed_or_count_[0]) + sizeof(claims_[0]));
}

}  // namespace stereod::semiglobal
