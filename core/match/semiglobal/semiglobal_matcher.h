// The semi-global matcher of one band, row by row.
#pragma once

#include <array>
#include <memory>

#include "core/match/band_matcher.h"
#include "core/match/row_ring.h"
#include "core/match/semiglobal/disparity_checks.h"
#include "core/match/semiglobal/kernels/kernel.h"
#include "core/match/semiglobal/pixel_costs.h"
#include "core/match/semiglobal/subsampled_disparity.h"

namespace stereod {

/// The matcher of docs/matcher.md, second part, by the kernel of an instruction set. Nothing goes down the
/// image but smoothing, median and the interpolation between rows of the grid, so rows are final about
/// twelve after they came in:
///   input rows → (1) costs of grid rows → (2) paths and tests of two of them → (3) median and filling
///   → (4) rows of the image.
class SemiglobalMatcher final : public BandMatcher {
 public:
  SemiglobalMatcher(const MatcherOptions& options, Size image);

  void use_masks(const ValidityMask* left, const ValidityMask* right) noexcept override {
    left_mask_ = left;
    right_mask_ = right;
  }
  RowRange begin(RowRange rows) noexcept override;
  std::uint8_t* left_row(int y) noexcept override { return left_input_.row(y) + kMargin; }
  std::uint8_t* right_row(int y) noexcept override { return right_input_.row(y) + kMargin; }
  RowRange push(int y) noexcept override;
  const std::int16_t* disparity_row(int y) const noexcept override { return output_rows_.row(y) + kValues; }
  std::size_t scratch_bytes() const noexcept override;

 private:
  static constexpr int kMargin = 32;  // pixels beside input rows
  static constexpr int kValues = semiglobal::kValueMargin;
  using GridValue = semiglobal::GridValue;

  int grid_height() const { return (image_.height + 1) / 2; }
  std::uint8_t* cost_row(int g) noexcept { return costs_.row(g) + shape_.point_bytes(); }
  GridValue* raw_row(int g) noexcept { return raw_.row(g) + kValues; }
  GridValue* wide_row(int g) noexcept { return wide_.row(g) + kValues; }

  void pad_row(std::uint8_t* row) const noexcept;
  semiglobal::PixelRows pixel_rows(RowRing<std::uint8_t>& input, int y) const noexcept;
  void compare_row(int g) noexcept;
  void match_two_rows() noexcept;
  void judge_row(int g, int of_two) noexcept;
  void finish_grid_row(int g) noexcept;
  void write_grid_row(int g, GridValue* row) noexcept;
  void write_row(int y, const GridValue* row) noexcept;
  void mask_row(int y, std::int16_t* out) const noexcept;

  MatcherOptions options_;
  Size image_;
  const semiglobal::Kernel& kernel_;
  semiglobal::Shape shape_;
  RowRange output_{};     // the band
  RowRange matched_{};    // rows of the grid whose winners are needed, the median's neighbors included
  RowRange compared_{};   // rows of the grid whose costs are smoothed into those
  int compared_end_ = 0;  // the next row for stage (1)
  int matched_end_ = 0;   // the next row for stage (2)
  int final_end_ = 0;     // rows of the band before this one are final

  RowRing<std::uint8_t> left_input_, right_input_;
  semiglobal::PixelCosts pixel_costs_;
  RowRing<std::uint8_t> costs_;     // with a point's worth on either side
  RowRing<std::uint8_t> limits_;    // P2 less the step in gray values from each point to the one at its left
  RowRing<std::uint8_t> likeness_;  // of the pixels between the points, see Kernel::likeness_row
  AlignedBuffer<std::uint8_t> padding_;
  Image<std::uint8_t> smoothed_, sums_;  // of two rows
  Image<std::uint16_t> winners_;
  semiglobal::DisparityChecks tests_;
  RowRing<GridValue> raw_;   // rows of the grid, before and
  Image<GridValue> median_;  // after the median
  RowRing<GridValue> wide_;  // the last two of them with a value for every column
  Image<GridValue> between_;
  RowRing<std::int16_t> output_rows_;
  const ValidityMask* left_mask_ = nullptr;
  const ValidityMask* right_mask_ = nullptr;
};

/// The same by semiglobal_by_definition(): all rows at the end.
std::unique_ptr<BandMatcher> make_defined_semiglobal_matcher(const MatcherOptions& options, Size image);

}  // namespace stereod
