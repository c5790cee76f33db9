// The block matcher: prefilter, search, tests and median of one band, row by row.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/match/band_matcher.h"
#include "core/match/block/disparity_checks.h"
#include "core/match/block/row_search.h"
#include "core/match/median.h"
#include "core/match/row_ring.h"

namespace stereod {

/// The sum-of-absolute-differences matcher of docs/matcher.md. A row passes through three stages, each of
/// which keeps only as many rows as the next one looks at:
///   input rows → (1) prefilter → prefiltered rows → (2) search and tests → raw disparities → (3) median.
class BlockMatcher final : public BandMatcher {
 public:
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
  std::int16_t* raw_row(int y) noexcept { return raw_.row(y) + kMedianMargin; }
  const std::int16_t* raw_row(int y) const noexcept { return raw_.row(y) + kMedianMargin; }
  const std::int16_t* invalid_row() const noexcept { return invalid_row_.data() + kMedianMargin; }

  void prefilter_row(int y) noexcept;
  void search_row(int y) noexcept;
  void search_waiting_rows() noexcept;
  void judge_row(int y, const RowWinners& winners) noexcept;
  void filter_row(int y) noexcept;
  void finish_rows(int end) noexcept;

  MatcherOptions options_;
  Size image_;
  RowRange answerable_{};  // rows of the image whose window lies in it; empty if no pixel can have an answer
  RowRange output_{};      // the band
  RowRange searched_{};    // rows whose winners are needed, the median's neighbors included
  RowRange compared_{};    // prefiltered rows that the windows of those cover
  int prefiltered_end_ = 0;  // the next row for stage (1)
  int searched_end_ = 0;     // the next row for stage (2)
  int final_end_ = 0;        // rows of the band before this one are final

  std::unique_ptr<RowSearch> search_;
  const int batch_;  // rows that stage (2) takes at once
  RowRing<std::uint8_t> left_input_, right_input_;
  RowRing<std::uint8_t> left_prefiltered_, right_prefiltered_;
  std::vector<SearchRow> waiting_;   // prefiltered, for stage (2); at most a batch
  std::vector<RowWinners> winners_;  // of a batch
  const ValidityMask* left_mask_ = nullptr;
  const ValidityMask* right_mask_ = nullptr;
  std::optional<LeftRightCheck> left_right_check_;
  std::optional<TextureCheck> texture_check_;
  RowRing<std::int16_t> raw_;  // with kMedianMargin invalid pixels on either side, like invalid_row_
  RowRing<std::int16_t> median_;
  AlignedBuffer<std::int16_t> invalid_row_;
};

}  // namespace stereod
