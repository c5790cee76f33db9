// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/block/block_matcher.h"

#include <algorithm>
#include <array>

namespace stereod {
namespace {

constexpr int kOutputRows = 8;  // more than the 5×5 median reads and one push() finishes

std::unique_ptr<RowSearch> make_search(const MatcherOptions& options, int width) {
  if (valid_columns(options, width).empty()) return nullptr;
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

}  // namespace

BlockMatcher::BlockMatcher(const MatcherOptions& options, Size image)
    : options_(options),
      image_(image),
      prefilter_stage_(prefiltered() ? 1 : 0),
      search_stage_(window_radius()),
      median_stage_(median_radius()),
      search_(make_search(options, image.width)),
      batch_size_(search_ != nullptr ? search_->batch_size() : 1),
      left_input_(image.width, options.window + batch_size_ + 1 + kRowsAhead),
      right_input_(image.width, options.window + batch_size_ + 1 + kRowsAhead),
      left_prefiltered_(prefiltered() ? image.width : 0, options.window + batch_size_),
      right_prefiltered_(prefiltered() ? image.width : 0, options.window + batch_size_),
      raw_(image.width, kOutputRows + batch_size_, kMedianMargin),
      median_(options.median > 0 ? image.width + kMedianMargin : 0, kOutputRows + batch_size_),
      invalid_row_(image.width, 1, kMedianMargin) {
  invalid_row_.fill(kInvalidDisparity);
  raw_.fill(kInvalidDisparity);
  if (options.left_right_max_diff >= 0) left_right_check_.emplace(image.width);
  if (options.texture_threshold > 0) texture_check_.emplace(image.width);
  const int r = window_radius();
  if (search_ != nullptr && image.height >= options.window) valid_rows_ = {r, image.height - r};
  batch_.reserve(static_cast<std::size_t>(batch_size_));
  const ColumnRange columns = valid_columns(options, image.width);
  for (int i = 0; i < batch_size_; ++i) {
    RowWinners& winners = winners_.emplace_back(image.width);
    winners.first = columns.first;
    winners.end = columns.end;
  }
}

RowRange BlockMatcher::begin(RowRange rows) noexcept {
  batch_.clear();
  const RowRange raw_rows = median_stage_.begin(rows, valid_rows_);
  if (raw_rows.empty()) {  // no disparities in this band: the first row pushed makes all rows final
    median_stage_.begin_without_input(rows);
    search_stage_.begin_without_input({rows.first, rows.first});
    prefilter_stage_.begin_without_input({rows.first, rows.first});
    return {rows.first, rows.first + 1};
  }
  const RowRange image_rows{0, image_.height};
  const RowRange gradient_rows = search_stage_.begin(raw_rows, image_rows);
  searched_input_end_ = gradient_rows.first;
  search_->reset();
  if (texture_check_) texture_check_->reset();
  return prefilter_stage_.begin(gradient_rows, image_rows);
}

RowRange BlockMatcher::push(int y) noexcept {
  const int first_final = median_stage_.made_end();
  while (prefilter_stage_.ready(y + 1)) {
    const int row = prefilter_stage_.take();
    if (prefiltered()) prefilter_row(row);
    add_to_batch(row);
  }
  while (median_stage_.ready(search_stage_.made_end())) {
    const int row = median_stage_.take();
    if (options_.median > 0 && median_stage_.input().contains(row)) filter_row(row);
  }
  return {first_final, median_stage_.made_end()};
}

void BlockMatcher::prefilter_row(int y) noexcept {
  const int above = mirrored_row(y - 1, image_.height);
  const int below = mirrored_row(y + 1, image_.height);
  const auto apply = [&](RowRing<std::uint8_t>& input, RowRing<std::uint8_t>& output) {
    search_->prefilter_row(input.row(above), input.row(y), input.row(below), image_.width,
                           options_.prefilter_cap, output.row(y));
  };
  apply(left_input_, left_prefiltered_);
  apply(right_input_, right_prefiltered_);
}

// Collects gradient rows until a batch is full or the band has no more of them.
void BlockMatcher::add_to_batch(int y) noexcept {
  RowRing<std::uint8_t>& left = prefiltered() ? left_prefiltered_ : left_input_;
  RowRing<std::uint8_t>& right = prefiltered() ? right_prefiltered_ : right_input_;
  const RowRange gradient_rows = search_stage_.input();
  const bool window_full = y - gradient_rows.first >= options_.window - 1;
  batch_.push_back({left.row(y), right.row(y), window_full ? &winners_[batch_.size()] : nullptr});
  if (static_cast<int>(batch_.size()) == batch_size_ || y + 1 == gradient_rows.end) search_batch();
}

// Slides the window down by the rows of the batch. Each row completes the raw disparities of the row
// window / 2 above it.
void BlockMatcher::search_batch() noexcept {
  search_->add_rows(batch_);
  for (const SearchRow& row : batch_) {
    const int y = searched_input_end_++;
    if (texture_check_) {
      const bool leaves = y - search_stage_.input().first >= options_.window;
      texture_check_->add_row(row.left, leaves ? left_prefiltered_.row(y - options_.window) : nullptr,
                              options_.prefilter_cap);
    }
    if (row.winners != nullptr) validate_row(search_stage_.take(), *row.winners);
  }
  batch_.clear();
}

// Writes the raw disparities of row y and invalidates those that fail a check.
void BlockMatcher::validate_row(int y, const RowWinners& winners) noexcept {
  std::int16_t* out = raw_.row(y);
  std::fill_n(out, winners.first, kInvalidDisparity);
  std::fill(out + winners.end, out + image_.width, kInvalidDisparity);
  search_->write(winners, out);
  if (texture_check_) texture_check_->reject(winners, options_, out);
  if (options_.uniqueness_ratio > 0) reject_ambiguous(winners, out);
  if (left_right_check_) left_right_check_->reject(winners, options_, out);
  if (const std::uint8_t* valid = row_with_holes(left_mask_, y)) reject_left(winners, valid, out);
  if (const std::uint8_t* valid = row_with_holes(right_mask_, y)) {
    reject_right(winners, options_.min_disparity, valid, out);
  }
}

void BlockMatcher::filter_row(int y) noexcept {
  std::array<const std::int16_t*, 5> rows;
  for (int i = 0; i < options_.median; ++i) {
    const int row = y + i - median_radius();
    rows[static_cast<std::size_t>(i)] = median_stage_.input().contains(row) ? raw_.row(row) : invalid_row();
  }
  median_row(rows.data(), image_.width, median_radius(), median_.row(y));
}

const std::int16_t* BlockMatcher::disparity_row(int y) const noexcept {
  if (!median_stage_.input().contains(y)) return invalid_row();
  return options_.median > 0 ? median_.row(y) : raw_.row(y);
}

std::size_t BlockMatcher::scratch_bytes() const noexcept {
  return left_input_.bytes() + right_input_.bytes() + left_prefiltered_.bytes() + right_prefiltered_.bytes() +
         raw_.bytes() + median_.bytes() + (search_ ? search_->scratch_bytes() : 0) +
         (left_right_check_ ? left_right_check_->scratch_bytes() : 0) +
         (texture_check_ ? texture_check_->scratch_bytes() : 0) + winners_.size() * winners_.front().bytes();
}

}  // namespace stereod
