// SPDX-License-Identifier: BSD-3-Clause
// The semi-global matcher of one band, row by row.
#pragma once

#include <memory>

#include "core/match/band_matcher.h"
#include "core/match/row_stage.h"
#include "core/match/semiglobal/disparity_checks.h"
#include "core/match/semiglobal/kernels/kernel.h"
#include "core/match/semiglobal/pixel_costs.h"
#include "core/match/semiglobal/subsampled_disparity.h"

namespace stereod {

/// Matches by costs of census and gradient, summed along two paths of each row (docs/matcher.md, part 2),
/// with the kernel of an instruction set. Works on a grid: every second row of the image, and every second
/// column or each. A row passes through these stages (row_stage.h):
///
///   stage       reads           border                    makes
///   costs       input rows      kCensusReach, scale 2     costs of a grid row, guide and P2 of its samples
///   paths       costs           kSmoothReach              raw disparities of two grid rows, checked
///   median      raw             median / 2                disparities of a grid row, holes filled
///   upsampling  grid rows       the row before            disparity rows
///
/// A row is final about twelve rows after it came in.
class SemiglobalMatcher final : public BandMatcher {
 public:
  /// Allocates all memory for images of size @p image. @p options have no problem_with().
  /// @throws std::invalid_argument if the CPU lacks `options.isa`.
  SemiglobalMatcher(const MatcherOptions& options, Size image);

  void use_masks(const ValidityMask* left, const ValidityMask* right) noexcept override {
    left_mask_ = left;
    right_mask_ = right;
  }
  RowRange begin(RowRange rows) noexcept override;
  std::uint8_t* left_row(int y) noexcept override { return left_input_.row(y); }
  std::uint8_t* right_row(int y) noexcept override { return right_input_.row(y); }
  RowRange push(int y) noexcept override;
  const std::int16_t* disparity_row(int y) const noexcept override { return output_rows_.row(y); }
  std::size_t scratch_bytes() const noexcept override;

 private:
  using SubsampledDisparity = semiglobal::SubsampledDisparity;

  RowRange grid_rows() const { return {0, (image_.height + 1) / 2}; }

  void pad_row(std::uint8_t* row) const noexcept;
  semiglobal::PixelRows pixel_rows(RowRing<std::uint8_t>& input, int y) const noexcept;
  void write_costs(int grid_y) noexcept;
  void match_two_rows() noexcept;
  void validate_row(int grid_y, int of_two) noexcept;
  void finish_grid_row(int grid_y) noexcept;
  void upsample_row(int grid_y, SubsampledDisparity* row) noexcept;
  void write_row(int y, const SubsampledDisparity* row) noexcept;
  void mask_row(int y, std::int16_t* out) const noexcept;

  MatcherOptions options_;
  Size image_;
  const semiglobal::Kernel& kernel_;
  semiglobal::SearchParams params_;
  RowRange output_{};                                // image rows of the band
  RowStage cost_stage_, path_stage_, median_stage_;  // grid rows
  int final_end_ = 0;                                // image rows of the band below this one are final

  RowRing<std::uint8_t> left_input_, right_input_;
  semiglobal::PixelCosts pixel_costs_;
  RowRing<std::uint8_t> costs_;  // margins: the costs of one sample
  RowRing<std::uint8_t> p2_;  // penalty of a jump from each sample to its left neighbor, see Kernel::adapt_p2
  RowRing<std::uint8_t> guide_;  // see Kernel::guide_row
  AlignedBuffer<std::uint8_t> padding_;
  RowRing<std::uint8_t> smoothed_, sums_;  // of the two grid rows that are matched together
  RowRing<std::uint16_t> winners_;
  semiglobal::DisparityChecks checks_;
  RowRing<SubsampledDisparity> raw_;           // grid rows before the median
  RowRing<SubsampledDisparity> median_;        // the grid row after it
  RowRing<SubsampledDisparity> upsampled_;     // the last two grid rows with a disparity in every column
  RowRing<SubsampledDisparity> interpolated_;  // the image row between these two
  RowRing<std::int16_t> output_rows_;
  const ValidityMask* left_mask_ = nullptr;
  const ValidityMask* right_mask_ = nullptr;
};

/// Returns a BandMatcher around semiglobal_reference(), for comparison with SemiglobalMatcher. For
/// every band it asks for all rows of the image, makes all rows of the band final with the last one, and
/// allocates memory in push().
std::unique_ptr<BandMatcher> make_reference_semiglobal_matcher(const MatcherOptions& options, Size image);

}  // namespace stereod
