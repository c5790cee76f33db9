// From the winners of a row of the grid to its disparities: interpolation and tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/match/options.h"
#include "core/match/semiglobal/kernels/kernel.h"
#include "core/match/semiglobal/subsampled_disparity.h"

namespace stereod::semiglobal {

/// Sections 2.3 and 2.4 of docs/matcher.md, of one row.
class DisparityChecks {
 public:
  DisparityChecks(const MatcherOptions& options, const Shape& shape, const Kernel& kernel);

  /// `sums` and `winners` as Kernel::paths_from_left leaves them. Masks are of the image row, null if all its
  /// pixels are valid.
  void write(const std::uint8_t* sums, const std::uint16_t* winners, const std::uint8_t* left_mask,
             const std::uint8_t* right_mask, GridValue* out) noexcept;
  std::size_t scratch_bytes() const noexcept;

 private:
  void find_winners(const std::uint8_t* sums, const std::uint16_t* winners) noexcept;
  template <int kVectors>
  void find_winners_among(const std::uint8_t* sums, const std::uint16_t* winners) noexcept;
  void reject_contested(GridValue* out) noexcept;
  void reject_ambiguous(const std::uint8_t* sums, const std::uint16_t* winners, GridValue* out) noexcept;
  void reject_masked(const std::uint8_t* left_mask, const std::uint8_t* right_mask,
                     GridValue* out) const noexcept;
  int column_shift() const { return shape_.decimation_x == 2 ? 1 : 0; }

  const MatcherOptions& options_;
  const Shape& shape_;
  const Kernel& kernel_;
  std::vector<std::uint8_t> before_, after_;  // where a disparity's neighbors stand
  // Of each point, and some more for whole vectors: the winning disparity, and the sums before and after it.
  std::vector<std::uint8_t> index_, sum_before_, sum_after_;
  // One test after the other: the right point it claims and the disparity that stands there; then how many
  // sums are no higher than rivals may be, and how high that is.
  std::vector<std::int16_t> claimed_or_count_;
  std::vector<std::uint8_t> standing_or_limit_;
  std::vector<std::uint16_t> claims_;   // best sum · 256 + disparity for right points
  std::vector<std::uint8_t> limit_of_;  // sums up to which are rivals of each least one
};

}  // namespace stereod::semiglobal
