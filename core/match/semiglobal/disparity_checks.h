// SPDX-License-Identifier: BSD-3-Clause
// From the winners of a grid row to its disparities: interpolation and checks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/match/options.h"
#include "core/match/semiglobal/kernels/kernel.h"
#include "core/match/semiglobal/subsampled_disparity.h"

namespace stereod::semiglobal {

/// Computes sections 2.3 and 2.4 of docs/matcher.md for one grid row at a time.
class DisparityChecks {
 public:
  /// The arguments must outlive this object.
  DisparityChecks(const MatcherOptions& options, const SearchParams& params, const Kernel& kernel);

  /// Writes the disparities of a grid row, kNoDisparity where a check fails. @p sums and @p winners are as
  /// Kernel::paths_from_left leaves them. The masks are rows of the image; null if all their pixels are
  /// valid.
  void write(const std::uint8_t* sums, const std::uint16_t* winners, const std::uint8_t* left_mask,
             const std::uint8_t* right_mask, SubsampledDisparity* out) noexcept;
  std::size_t scratch_bytes() const noexcept;

 private:
  void find_winners(const std::uint8_t* sums, const std::uint16_t* winners) noexcept;
  template <int kVectors>
  void find_winners_in(const std::uint8_t* sums, const std::uint16_t* winners) noexcept;
  void reject_inconsistent(SubsampledDisparity* out) noexcept;
  void reject_ambiguous(const std::uint8_t* sums, const std::uint16_t* winners,
                        SubsampledDisparity* out) noexcept;
  void reject_masked(const std::uint8_t* left_mask, const std::uint8_t* right_mask,
                     SubsampledDisparity* out) const noexcept;
  int column_shift() const { return params_.decimation_x == 2 ? 1 : 0; }

  const MatcherOptions& options_;
  const SearchParams& params_;
  const Kernel& kernel_;
  std::vector<std::uint8_t> offset_before_, offset_after_;  // lane offsets of k − 1 and k + 1
  // By sample, with room for whole vectors: k of the winner, the sums of k − 1 and k + 1.
  std::vector<std::uint8_t> index_, sum_before_, sum_after_;
  // By sample, used by one check after the other: first the right sample that it matches and k of that one's
  // best match; then the number of sums up to the uniqueness limit, and that limit.
  std::vector<std::int16_t> match_or_count_;
  std::vector<std::uint8_t> best_k_or_limit_;
  std::vector<std::uint16_t> best_match_;       // by right sample: minimum sum · 256 + k
  std::vector<std::uint8_t> uniqueness_limit_;  // by minimum sum
};

}  // namespace stereod::semiglobal
