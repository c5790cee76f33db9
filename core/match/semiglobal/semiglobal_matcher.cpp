#include "core/match/semiglobal/semiglobal_matcher.h"

#include <algorithm>

#include "core/base/cpu.h"

namespace stereod {
namespace {

using semiglobal::kCensusReach;
using semiglobal::kSmoothReach;
using semiglobal::Shape;

constexpr int kCostRows = 2 * kSmoothReach + 2;  // that two rows are smoothed from
constexpr int kLikenessRows = kCostRows;         // from the last row compared to those that become final
constexpr int kRawRows = 4;                      // more than the median looks at
constexpr int kOutputRows = 12;                  // as many as the last push finishes

Shape shape_for(const MatcherOptions& options, int width, int lanes) {
  Shape shape{};
  shape.width = width;
  shape.min_disparity = options.min_disparity;
  shape.disparities = options.disparities;
  shape.vectors = (options.disparities + lanes - 1) / lanes;
  shape.lanes = lanes;
  shape.decimation_x = options.grid == Grid::kCoarse ? 2 : 1;
  shape.gradient_limit = options.gradient_limit;
  shape.p1 = options.p1;
  return shape;
}

RowRange grown(RowRange rows, int by, int height) {
  return {std::max(rows.first - by, 0), std::min(rows.end + by, height)};
}

}  // namespace

SemiglobalMatcher::SemiglobalMatcher(const MatcherOptions& options, Size image)
    : options_(options),
      image_(image),
      kernel_(semiglobal::kernel_for(resolve_isa(options.isa))),
      shape_(shape_for(options, image.width, kernel_.lanes)),
      left_input_(shape_.row_bytes() + 2 * kMargin, 2 * kCensusReach + 2 + kRowsAhead),
      right_input_(shape_.row_bytes() + 2 * kMargin, 2 * kCensusReach + 2 + kRowsAhead),
      pixel_costs_(options_, shape_, kernel_),
      costs_((shape_.grid_width() + 2) * shape_.point_bytes(), kCostRows),
      limits_(shape_.grid_width() + kValues, kCostRows),
      likeness_(image.width + kValues, kLikenessRows),
      padding_(static_cast<std::size_t>(shape_.point_bytes())),
      smoothed_(shape_.grid_width() * shape_.point_bytes(), 2),
      sums_(shape_.grid_width() * shape_.point_bytes(), 2),
      winners_(shape_.grid_width() + kValues, 2),
      tests_(options_, shape_, kernel_),
      raw_(shape_.grid_width() + 2 * kValues, kRawRows),
      median_(shape_.grid_width() + 2 * kValues, 1),
      wide_(image.width + 2 * kValues, 2),
      between_(image.width + 2 * kValues, 1),
      output_rows_(image.width + 2 * kValues, kOutputRows) {
  for (int k = options.disparities; k < shape_.point_bytes(); ++k) {
    padding_[static_cast<std::size_t>(shape_.place(k))] = 255;
  }
}

RowRange SemiglobalMatcher::begin(RowRange rows) noexcept {
  output_ = rows;
  final_end_ = rows.first;
  const RowRange written{rows.first / 2, std::min(rows.end / 2 + 1, grid_height())};
  matched_ = grown(written, options_.median / 2, grid_height());
  compared_ = grown(matched_, kSmoothReach, grid_height());
  compared_end_ = compared_.first;
  matched_end_ = matched_.first;
  return grown({2 * compared_.first, 2 * compared_.end - 1}, kCensusReach, image_.height);
}

RowRange SemiglobalMatcher::push(int y) noexcept {
  const int before = final_end_;
  pad_row(left_row(y));
  pad_row(right_row(y));
  while (compared_end_ < compared_.end && (2 * compared_end_ + kCensusReach <= y || y == image_.height - 1)) {
    compare_row(compared_end_++);
    while (matched_end_ < matched_.end &&
           compared_end_ >= std::min(matched_end_ + kSmoothReach + 2, compared_.end)) {
      match_two_rows();
    }
  }
  return {before, final_end_};
}

void SemiglobalMatcher::pad_row(std::uint8_t* row) const noexcept {
  std::fill_n(row - kCensusReach, kCensusReach, row[0]);
  std::fill_n(row + image_.width, kCensusReach, row[image_.width - 1]);
}

semiglobal::PixelRows SemiglobalMatcher::pixel_rows(RowRing<std::uint8_t>& input, int y) const noexcept {
  const int last = image_.height - 1;
  const auto row = [&](int v) { return input.row(v) + kMargin; };
  semiglobal::PixelRows rows{};
  for (int dy = -kCensusReach; dy <= kCensusReach; ++dy) {
    rows.census[kCensusReach + dy] = row(std::clamp(y + dy, 0, last));
  }
  rows.above = row(y > 0 ? y - 1 : std::min(1, last));
  rows.row = row(y);
  rows.below = row(y < last ? y + 1 : std::max(last - 1, 0));
  return rows;
}

// Takes all that the later stages need of the input, whose rows do not stay.
void SemiglobalMatcher::compare_row(int g) noexcept {
  const int y = 2 * g;
  pixel_costs_.write(pixel_rows(left_input_, y), pixel_rows(right_input_, y), cost_row(g));
  const auto left = [&](int v) { return left_row(std::min(v, image_.height - 1)); };
  kernel_.likeness_row(left(y), left(y + 1), left(y + 2), image_.width, likeness_.row(g));
  kernel_.step_limits(left_row(y), shape_.grid_width(), shape_.decimation_x, options_.p2, limits_.row(g));
}

// Of an odd number of rows the last one is done together with one that nobody asks for.
void SemiglobalMatcher::match_two_rows() noexcept {
  const int first = matched_end_;
  semiglobal::PathRows rows{};
  for (int i = 0; i < kCostRows; ++i) {
    rows.costs[i] = cost_row(std::clamp(first - kSmoothReach + i, compared_.first, compared_.end - 1));
  }
  rows.padding = padding_.data();
  for (int i = 0; i < 2; ++i) {
    rows.p2[i] = limits_.row(std::min(first + i, matched_.end - 1));
    rows.smoothed[i] = smoothed_.row(i);
    rows.sums[i] = sums_.row(i);
    rows.winners[i] = winners_.row(i);
  }
  kernel_.paths_from_right(shape_, rows);
  kernel_.paths_from_left(shape_, rows);
  for (int i = 0; i < 2 && matched_end_ < matched_.end; ++i) judge_row(matched_end_++, i);
}

void SemiglobalMatcher::judge_row(int g, int of_two) noexcept {
  const int y = 2 * g;
  const auto mask_of = [y](const ValidityMask* mask) {
    return mask == nullptr || mask->row_is_whole(y) ? nullptr : mask->row(y);
  };
  tests_.write(sums_.row(of_two), winners_.row(of_two), mask_of(left_mask_), mask_of(right_mask_),
               raw_row(g));
  const bool last = g == grid_height() - 1;
  if (options_.median == 0) return finish_grid_row(g);
  if (g > matched_.first) finish_grid_row(g - 1);
  if (last) finish_grid_row(g);
}

// The row after it is there, if there is one and the median looks at it.
void SemiglobalMatcher::finish_grid_row(int g) noexcept {
  const int width = shape_.grid_width();
  GridValue* row = raw_row(g);
  if (options_.median > 0) {
    row = median_.row(0) + kValues;
    if (g == 0 || g == grid_height() - 1) {
      std::copy_n(raw_row(g), width, row);
    } else if (g == matched_.first) {
      return;  // only there for the median of the next one
    } else {
      kernel_.median_row(raw_row(g - 1), raw_row(g), raw_row(g + 1), width, options_.hole_filling, row);
    }
  }
  if (options_.hole_filling) semiglobal::fill_grid_row(row, width);
  write_grid_row(g, row);
}

void SemiglobalMatcher::write_grid_row(int g, GridValue* row) noexcept {
  if (options_.grid == Grid::kCoarse) {
    kernel_.widen_row(row, image_.width, likeness_.row(g), wide_row(g));
  } else {
    std::copy_n(row, image_.width, wide_row(g));
  }
  const int y = 2 * g;
  if (y - 1 >= output_.first && y - 1 < output_.end) {
    GridValue* between = between_.row(0) + kValues;
    kernel_.between_rows(wide_row(g - 1), wide_row(g), image_.width, likeness_.row(g - 1), between);
    write_row(y - 1, between);
  }
  if (y >= output_.first && y < output_.end) write_row(y, wide_row(g));
  if (g == grid_height() - 1 && y + 1 >= output_.first && y + 1 < output_.end) write_row(y + 1, wide_row(g));
}

void SemiglobalMatcher::write_row(int y, const GridValue* row) noexcept {
  std::int16_t* const out = output_rows_.row(y) + kValues;
  kernel_.disparities_of_row(
      row, image_.width,
      {options_.min_disparity, options_.disparities, options_.subpixel, options_.hole_filling}, out);
  mask_row(y, out);
  final_end_ = y + 1;
}

void SemiglobalMatcher::mask_row(int y, std::int16_t* out) const noexcept {
  if (right_mask_ != nullptr && !right_mask_->row_is_whole(y)) {
    const std::uint8_t* valid = right_mask_->row(y);
    for (int x = 0; x < image_.width; ++x) {
      if (out[x] < 0) continue;
      const int whole = options_.subpixel ? (out[x] + kSubpixelUnits / 2) >> 4 : out[x];
      if (valid[x - whole] == 0) out[x] = options_.hole_filling ? as_filled(out[x]) : kInvalidDisparity;
    }
  }
  if (left_mask_ != nullptr && !left_mask_->row_is_whole(y)) {
    const std::uint8_t* valid = left_mask_->row(y);
    for (int x = 0; x < image_.width; ++x) {
      if (valid[x] == 0) out[x] = kInvalidDisparity;
    }
  }
}

std::size_t SemiglobalMatcher::scratch_bytes() const noexcept {
  const auto bytes = [](const auto& image) {
    return static_cast<std::size_t>(image.view().stride()) * static_cast<std::size_t>(image.height());
  };
  return left_input_.bytes() + right_input_.bytes() + pixel_costs_.scratch_bytes() + costs_.bytes() +
         limits_.bytes() + likeness_.bytes() + padding_.size() + bytes(smoothed_) + bytes(sums_) +
         bytes(winners_) + tests_.scratch_bytes() + raw_.bytes() + bytes(median_) + wide_.bytes() +
         bytes(between_) + output_rows_.bytes();
}

}  // namespace stereod
