// SPDX-License-Identifier: BSD-3-Clause
// The block matcher: prefilter, search, checks and median of one band, row by row.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/match/band_matcher.h"
#include "core/match/block/disparity_checks.h"
#include "core/match/block/row_search.h"
#include "core/match/median.h"
#include "core/match/row_stage.h"

namespace stereod {

/// Matches by sums of absolute differences over a window (docs/matcher.md, part 1). A row passes through
/// three stages (row_stage.h):
///
///   stage      reads              border               makes
///   prefilter  input rows         1 (0 without)        gradient rows
///   search     gradient rows      window / 2           raw disparities, checked (disparity_checks.h)
///   median     raw disparities    median / 2           disparity rows
class BlockMatcher final : public BandMatcher {
 public:
  /// Allocates all memory for images of size @p image. @p options have no problem_with().
  BlockMatcher(const MatcherOptions& options, Size image);

  void use_masks(const ValidityMask* left, const ValidityMask* right) noexcept override {
    left_mask_ = left;
    right_mask_ = right;
  }
  RowRange begin(RowRange rows) noexcept override;
  std::uint8_t* left_row(int y) noexcept override { return left_input_.row(y); }
  std::uint8_t* right_row(int y) noexcept override { return right_input_.row(y); }
  RowRange push(int y) noexcept override;
  const std::int16_t* disparity_row(int y) const noexcept override;
  std::size_t scratch_bytes() const noexcept override;

 private:
  bool prefiltered() const { return options_.prefilter == Prefilter::kXsobel; }
  int window_radius() const { return options_.window / 2; }
  int median_radius() const { return options_.median / 2; }
  const std::int16_t* invalid_row() const noexcept { return invalid_row_.row(0); }

  void prefilter_row(int y) noexcept;
  void add_to_batch(int y) noexcept;
  void search_batch() noexcept;
  void validate_row(int y, const RowWinners& winners) noexcept;
  void filter_row(int y) noexcept;

  MatcherOptions options_;
  Size image_;
  RowRange
      valid_rows_{};  // image rows whose window lies in the image; empty if no pixel can have a disparity
  RowStage prefilter_stage_, search_stage_, median_stage_;
  int searched_input_end_ = 0;  // the next gradient row for the search

  std::unique_ptr<RowSearch> search_;  // null if no column can have a disparity
  const int batch_size_;               // rows that the search takes at once
  RowRing<std::uint8_t> left_input_, right_input_;
  RowRing<std::uint8_t> left_prefiltered_, right_prefiltered_;
  std::vector<SearchRow> batch_;     // gradient rows that wait for the search
  std::vector<RowWinners> winners_;  // one for each row of a batch
  const ValidityMask* left_mask_ = nullptr;
  const ValidityMask* right_mask_ = nullptr;
  std::optional<LeftRightCheck> left_right_check_;
  std::optional<TextureCheck> texture_check_;
  RowRing<std::int16_t> raw_;  // margins: kMedianMargin invalid pixels, as in invalid_row_
  RowRing<std::int16_t> median_;
  RowRing<std::int16_t> invalid_row_;
};

}  // namespace stereod
