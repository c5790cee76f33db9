#include "core/match/block/block_matcher.h"

#include <algorithm>
#include <array>

namespace stereod {
namespace {

constexpr int kOutputRows = 8;  // more than the widest median looks at and one push finishes

std::unique_ptr<RowSearch> make_search(const MatcherOptions& options, int width) {
  if (first_answered_column(options) >= end_answered_column(options, width)) return nullptr;
  switch (options.implementation) {
    case Implementation::kNaive:
      return make_naive_search(options, width);
    case Implementation::kSliding:
      return make_sliding_search(options, width);
    case Implementation::kSimd:
      break;
  }
  return make_simd_search(options, width);
}

RowRange grown(RowRange rows, int by, RowRange within) {
  return {std::max(rows.first - by, within.first), std::min(rows.end + by, within.end)};
}

}  // namespace

BlockMatcher::BlockMatcher(const MatcherOptions& options, Size image)
    : options_(options),
      image_(image),
      search_(make_search(options, image.width)),
      batch_(search_ != nullptr ? search_->batch() : 1),
      left_input_(image.width, options.window + batch_ + 1 + kRowsAhead),
      right_input_(image.width, options.window + batch_ + 1 + kRowsAhead),
      left_prefiltered_(prefiltered() ? image.width : 0, options.window + batch_),
      right_prefiltered_(prefiltered() ? image.width : 0, options.window + batch_),
      raw_(image.width + 2 * kMedianMargin, kOutputRows + batch_),
      median_(options.median > 0 ? image.width + kMedianMargin : 0, kOutputRows + batch_),
      invalid_row_(static_cast<std::size_t>(image.width + 2 * kMedianMargin)) {
  std::fill(invalid_row_.begin(), invalid_row_.end(), kInvalidDisparity);
  for (int y = 0; y < kOutputRows + batch_; ++y) {
    std::fill_n(raw_.row(y), image.width + 2 * kMedianMargin, kInvalidDisparity);
  }
  if (options.left_right_max_diff >= 0) left_right_check_.emplace(image.width);
  if (options.texture_threshold > 0) texture_check_.emplace(image.width);
  const int r = window_radius();
  if (search_ != nullptr && image.height >= options.window) answerable_ = {r, image.height - r};
  waiting_.reserve(static_cast<std::size_t>(batch_));
  for (int i = 0; i < batch_; ++i) {
    RowWinners& winners = winners_.emplace_back(image.width);
    winners.first = first_answered_column(options);
    winners.end = end_answered_column(options, image.width);
  }
}

RowRange BlockMatcher::begin(RowRange rows) noexcept {
  output_ = rows;
  final_end_ = rows.first;
  searched_ = grown(rows, median_radius(), answerable_);
  if (searched_.first >= searched_.end) {  // nothing to match: one row to push, and all is final
    searched_ = compared_ = {rows.first, rows.first};
    prefiltered_end_ = searched_end_ = rows.first;
    return {rows.first, rows.first + 1};
  }
  const RowRange image{0, image_.height};
  compared_ = grown(searched_, window_radius(), image);
  prefiltered_end_ = searched_end_ = compared_.first;
  waiting_.clear();
  search_->reset();
  if (texture_check_) texture_check_->reset();
  return prefiltered() ? grown(compared_, 1, image) : compared_;
}

RowRange BlockMatcher::push(int y) noexcept {
  const int before = final_end_;
  // The Sobel gradient looks one row down; below the last row it sees the last but one again.
  const int ready_end = prefiltered() && y < image_.height - 1 ? y : y + 1;
  while (prefiltered_end_ < std::min(ready_end, compared_.end)) {
    const int row = prefiltered_end_++;
    if (prefiltered()) prefilter_row(row);
    search_row(row);
  }
  const int searched_end = std::max(searched_end_ - window_radius(), searched_.first);
  if (searched_end >= searched_.end) {
    finish_rows(output_.end);
  } else {
    finish_rows(std::max(searched_end - median_radius(), std::min(answerable_.first, output_.end)));
  }
  return {before, final_end_};
}

void BlockMatcher::prefilter_row(int y) noexcept {
  const int above = y > 0 ? y - 1 : std::min(1, image_.height - 1);
  const int below = y < image_.height - 1 ? y + 1 : std::max(image_.height - 2, 0);
  const auto apply = [&](RowRing<std::uint8_t>& input, RowRing<std::uint8_t>& output) {
    search_->prefilter_row(input.row(above), input.row(y), input.row(below), image_.width,
                           options_.prefilter_cap, output.row(y));
  };
  apply(left_input_, left_prefiltered_);
  apply(right_input_, right_prefiltered_);
}

// Adds row y to the windows, with others once a batch waits; when they are full, finds the disparities of the
// row in their middle.
void BlockMatcher::search_row(int y) noexcept {
  RowRing<std::uint8_t>& left = prefiltered() ? left_prefiltered_ : left_input_;
  RowRing<std::uint8_t>& right = prefiltered() ? right_prefiltered_ : right_input_;
  const bool full = y - compared_.first >= options_.window - 1;
  waiting_.push_back({left.row(y), right.row(y), full ? &winners_[waiting_.size()] : nullptr});
  if (static_cast<int>(waiting_.size()) == batch_ || y + 1 == compared_.end) search_waiting_rows();
}

void BlockMatcher::search_waiting_rows() noexcept {
  search_->add_rows(waiting_);
  for (const SearchRow& row : waiting_) {
    const int y = searched_end_++;
    if (texture_check_) {
      const bool leaves = y - compared_.first >= options_.window;
      texture_check_->add_row(row.left, leaves ? left_prefiltered_.row(y - options_.window) : nullptr,
                              options_.prefilter_cap);
    }
    if (row.winners != nullptr) judge_row(y - window_radius(), *row.winners);
  }
  waiting_.clear();
}

// From the winners of row y to its disparities: the tests.
void BlockMatcher::judge_row(int y, const RowWinners& winners) noexcept {
  std::int16_t* out = raw_row(y);
  std::fill_n(out, winners.first, kInvalidDisparity);
  std::fill(out + winners.end, out + image_.width, kInvalidDisparity);
  search_->write(winners, out);
  if (texture_check_) texture_check_->reject(winners, options_, out);
  if (options_.uniqueness_ratio > 0) reject_ambiguous(winners, out);
  if (left_right_check_) left_right_check_->reject(winners, options_, out);
  if (left_mask_ != nullptr && !left_mask_->row_is_whole(y)) reject_left(winners, left_mask_->row(y), out);
  if (right_mask_ != nullptr && !right_mask_->row_is_whole(y)) {
    reject_right(winners, options_.min_disparity, right_mask_->row(y), out);
  }
}

void BlockMatcher::finish_rows(int end) noexcept {
  for (; final_end_ < std::min(end, output_.end); ++final_end_) {
    const bool searched = final_end_ >= searched_.first && final_end_ < searched_.end;
    if (searched && options_.median > 0) filter_row(final_end_);
  }
}

void BlockMatcher::filter_row(int y) noexcept {
  std::array<const std::int16_t*, 5> rows;
  for (int i = 0; i < options_.median; ++i) {
    const int row = y + i - median_radius();
    rows[static_cast<std::size_t>(i)] =
        row >= searched_.first && row < searched_.end ? raw_row(row) : invalid_row();
  }
  median_row(rows.data(), image_.width, median_radius(), median_.row(y));
}

const std::int16_t* BlockMatcher::disparity_row(int y) const noexcept {
  if (y < searched_.first || y >= searched_.end) return invalid_row();
  return options_.median > 0 ? median_.row(y) : raw_row(y);
}

std::size_t BlockMatcher::scratch_bytes() const noexcept {
  return left_input_.bytes() + right_input_.bytes() + left_prefiltered_.bytes() + right_prefiltered_.bytes() +
         raw_.bytes() + median_.bytes() + (search_ ? search_->scratch_bytes() : 0) +
         (left_right_check_ ? left_right_check_->scratch_bytes() : 0) +
         (texture_check_ ? texture_check_->scratch_bytes() : 0) + winners_.size() * winners_.front().bytes();
}

}  // namespace stereod
