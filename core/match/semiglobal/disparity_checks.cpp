// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/disparity_checks.h"

#include <algorithm>

#include "core/base/simd_i16x8.h"

namespace stereod::semiglobal {
namespace {

constexpr int kMaxSum = 255;  // a sum

std::size_t as_size(int value) { return static_cast<std::size_t>(value); }

}  // namespace

DisparityChecks::DisparityChecks(const MatcherOptions& options, const SearchParams& params,
                                 const Kernel& kernel)
    : options_(options),
      params_(params),
      kernel_(kernel),
      offset_before_(as_size(params.disparities)),
      offset_after_(as_size(params.disparities)),
      index_(as_size(params.grid_width() + kDisparityMargin)),
      sum_before_(index_.size()),
      sum_after_(index_.size()),
      match_or_count_(index_.size()),
      best_k_or_limit_(index_.size()),
      best_match_(index_.size()),
      uniqueness_limit_(kMaxSum + 1) {
  for (int minimum = 0; minimum <= kMaxSum; ++minimum) {
    const int limit = minimum + minimum * options.uniqueness_ratio / 100;
    uniqueness_limit_[as_size(minimum)] = static_cast<std::uint8_t>(std::min(limit, kMaxSum));
  }
  const int last = params.disparities - 1;
  for (int k = 0; k <= last; ++k) {  // the first and the last k have one neighbor on both sides: no slope
    const int before = k == 0 ? std::min(1, last) : k - 1;
    const int after = k == last ? std::max(last - 1, 0) : k + 1;
    offset_before_[as_size(k)] = static_cast<std::uint8_t>(params.lane_offset(before));
    offset_after_[as_size(k)] = static_cast<std::uint8_t>(params.lane_offset(after));
  }
}

void DisparityChecks::write(const std::uint8_t* sums, const std::uint16_t* winners,
                            const std::uint8_t* left_mask, const std::uint8_t* right_mask,
                            SubsampledDisparity* out) noexcept {
  find_winners(sums, winners);
  kernel_.refine_winners(params_, {winners, index_.data(), sum_before_.data(), sum_after_.data()}, out);
  if (options_.left_right_max_diff >= 0) reject_inconsistent(out);
  if (options_.uniqueness_ratio > 0) reject_ambiguous(sums, winners, out);
  if (left_mask != nullptr || right_mask != nullptr) reject_masked(left_mask, right_mask, out);
}

void DisparityChecks::find_winners(const std::uint8_t* sums, const std::uint16_t* winners) noexcept {
  switch (params_.vectors) {  // as compile-time constants, 2 and 4 take a third less time
    case 2:
      return find_winners_in<2>(sums, winners);
    case 4:
      return find_winners_in<4>(sums, winners);
    default:
      return find_winners_in<0>(sums, winners);
  }
}

// Does what needs table lookups, sample by sample: k of the winner, the sums beside it, and the best match of
// each right sample.
template <int kVectors>
void DisparityChecks::find_winners_in(const std::uint8_t* sums, const std::uint16_t* winners) noexcept {
  const int width = params_.grid_width();
  const int vectors = kVectors > 0 ? kVectors : params_.vectors;
  const std::ptrdiff_t lanes = params_.lanes;
  const int shift = column_shift();
  const std::ptrdiff_t sample_bytes = params_.sample_bytes();
  const std::uint8_t* const before = offset_before_.data();
  const std::uint8_t* const after = offset_after_.data();
  std::uint8_t* const index = index_.data();
  std::uint8_t* const sum_before = sum_before_.data();
  std::uint8_t* const sum_after = sum_after_.data();
  std::int16_t* const matched = match_or_count_.data();
  std::uint16_t* const best_match = best_match_.data();
  std::fill_n(best_match, width, std::uint16_t{0xFFFF});
  const std::uint8_t* sample = sums;
  int column = -params_.min_disparity;
  for (std::ptrdiff_t x = 0; x < width; ++x, sample += sample_bytes, column += 1 << shift) {
    const unsigned lane = winners[x] & 0xFFU;
    const unsigned minimum = winners[x] >> 8;
    unsigned k = lane * static_cast<unsigned>(vectors);
    unsigned searching = 1;  // no branch: which vector holds the minimum is unpredictable
    const std::uint8_t* candidate = sample + lane;
#pragma GCC unroll 4
    for (int vector = 0; vector + 1 < vectors; ++vector, candidate += lanes) {
      searching &= *candidate != minimum ? 1U : 0U;
      k += searching;
    }
    index[x] = static_cast<std::uint8_t>(k);
    sum_before[x] = sample[before[k]];
    sum_after[x] = sample[after[k]];
    const int match = column - static_cast<int>(k);
    matched[x] = 0;
    if (match < 0) continue;
    matched[x] = static_cast<std::int16_t>(match >> shift);
    std::uint16_t& best = best_match[matched[x]];
    const auto sum_and_k = static_cast<std::uint16_t>(minimum << 8 | k);
    best = sum_and_k < best ? sum_and_k : best;
  }
}

void DisparityChecks::reject_inconsistent(SubsampledDisparity* out) noexcept {
  const int width = params_.grid_width();
  const std::uint8_t* const index = index_.data();
  const std::int16_t* const matched = match_or_count_.data();
  const std::uint16_t* const best_match = best_match_.data();
  std::uint8_t* const best_k = best_k_or_limit_.data();
#pragma GCC unroll 4
  for (std::ptrdiff_t x = 0; x < width; ++x) best_k[x] = static_cast<std::uint8_t>(best_match[matched[x]]);
  const auto max_diff = static_cast<std::int16_t>(options_.left_right_max_diff);
  for (int x = 0; x < width; x += kI16Lanes) {
    const I16x8 difference = load_i16x8(best_k + x) - load_i16x8(index + x);
    store_i16x8(out + x, load_i16x8(out + x) | (difference > max_diff) | (-difference > max_diff));
  }
}

// A rival is a sum within the uniqueness limit that is neither the winner nor a neighbor of it.
void DisparityChecks::reject_ambiguous(const std::uint8_t* sums, const std::uint16_t* winners,
                                       SubsampledDisparity* out) noexcept {
  const int width = params_.grid_width();
  const std::uint8_t* const limit_by_minimum = uniqueness_limit_.data();
  std::uint8_t* const limits = best_k_or_limit_.data();
#pragma GCC unroll 4
  for (std::ptrdiff_t x = 0; x < width; ++x) limits[x] = limit_by_minimum[winners[x] >> 8];
  kernel_.count_less_equal(params_, sums, best_k_or_limit_.data(), match_or_count_.data());
  const auto padding = static_cast<std::int16_t>(params_.sample_bytes() -
                                                 params_.disparities);  // counted if the limit is kMaxSum
  const auto last = static_cast<std::int16_t>(params_.disparities - 1);
  for (int x = 0; x < width; x += kI16Lanes) {
    const I16x8 limit = load_i16x8(best_k_or_limit_.data() + x), k = load_i16x8(index_.data() + x);
    // −1 where a neighbor was counted. The first and the last k have only one neighbor, which counts once.
    const I16x8 before = load_i16x8(sum_before_.data() + x) <= limit;
    const I16x8 after = (load_i16x8(sum_after_.data() + x) <= limit) & (k != 0) & (k != last);
    const I16x8 counted = load_i16x8(match_or_count_.data() + x) - ((limit == kMaxSum) & padding);
    store_i16x8(out + x, load_i16x8(out + x) | (counted - 1 + before + after > I16x8{}));
  }
}

void DisparityChecks::reject_masked(const std::uint8_t* left_mask, const std::uint8_t* right_mask,
                                    SubsampledDisparity* out) const noexcept {
  for (int x = 0; x < params_.grid_width(); ++x) {
    if (out[x] < 0) continue;
    const int column = x * params_.decimation_x;
    const bool left = left_mask == nullptr || left_mask[column] != 0;
    const bool right =
        right_mask == nullptr || right_mask[column - params_.min_disparity - index_[as_size(x)]] != 0;
    if (!left || !right) out[x] = kNoDisparity;
  }
}

std::size_t DisparityChecks::scratch_bytes() const noexcept {
  return offset_before_.size() + offset_after_.size() + 3 * index_.size() + best_k_or_limit_.size() +
         uniqueness_limit_.size() +
         match_or_count_.size() * (sizeof(match_or_count_[0]) + sizeof(best_match_[0]));
}

}  // namespace stereod::semiglobal
