// SPDX-License-Identifier: BSD-3-Clause
// From the rows of two images to the costs of a grid row.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/aligned_buffer.h"
#include "core/match/options.h"
#include "core/match/semiglobal/kernels/kernel.h"

namespace stereod::semiglobal {

/// A row of pixels and its neighbors. Rows beyond the image are clamped for the census and mirrored for the
/// gradient.
struct PixelRows {
  const std::uint8_t* census[2 * kCensusReach + 1];  ///< from two rows above to two below
  const std::uint8_t* above;                         ///< for the gradient
  const std::uint8_t* row;
  const std::uint8_t* below;
};

/// Drives the cost functions of a kernel and owns the memory that they need.
class PixelCosts {
 public:
  /// @p params and @p kernel must outlive this object.
  PixelCosts(const MatcherOptions& options, const SearchParams& params, const Kernel& kernel);

  /// Writes the costs of a grid row to @p costs, as CostRow::costs describes them.
  void write(const PixelRows& left, const PixelRows& right, std::uint8_t* costs) noexcept;
  std::size_t scratch_bytes() const noexcept;

 private:
  void describe(const PixelRows& rows, int shift, std::uint8_t* planes) noexcept;

  const SearchParams& params_;
  const Kernel& kernel_;
  int prefilter_cap_;
  AlignedBuffer<std::uint8_t> tables_;
  AlignedBuffer<std::int32_t> offsets_;
  AlignedBuffer<std::uint8_t> left_, right_;  // [kPlanes][row_bytes]
  AlignedBuffer<std::uint8_t> scratch_;
  AlignedBuffer<std::uint8_t> stripes_;
};

}  // namespace stereod::semiglobal
