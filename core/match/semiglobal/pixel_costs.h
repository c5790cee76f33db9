// From two rows of images to the costs of a row of the grid.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/aligned_buffer.h"
#include "core/match/options.h"
#include "core/match/semiglobal/kernels/kernel.h"

namespace stereod::semiglobal {

/// A row of pixels with its neighbors, from two above it to two below, as Kernel::census_row wants them; the
/// rows above and below are also those that the gradient takes.
struct PixelRows {
  const std::uint8_t* census[2 * kCensusReach + 1];
  const std::uint8_t* above;
  const std::uint8_t* row;
  const std::uint8_t* below;
};

/// Drives the first half of a kernel, with the memory that it needs.
class PixelCosts {
 public:
  PixelCosts(const MatcherOptions& options, const Shape& shape, const Kernel& kernel);

  /// Writes the costs of a row of the grid, as CostRow::costs.
  void write(const PixelRows& left, const PixelRows& right, std::uint8_t* costs) noexcept;
  std::size_t scratch_bytes() const noexcept;

 private:
  void describe(const PixelRows& rows, int shift, std::uint8_t* planes) noexcept;

  const Shape& shape_;
  const Kernel& kernel_;
  int prefilter_cap_;
  AlignedBuffer<std::uint8_t> tables_;
  AlignedBuffer<std::int32_t> offsets_;
  AlignedBuffer<std::uint8_t> left_, right_;  // [kPlanes][row_bytes]
  AlignedBuffer<std::uint8_t> scratch_;
  AlignedBuffer<std::uint8_t> stripes_;
};

}  // namespace stereod::semiglobal
