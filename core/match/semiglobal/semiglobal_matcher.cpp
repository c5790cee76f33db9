// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/semiglobal_matcher.h"

#include <algorithm>

#include "core/base/cpu.h"

namespace stereod {
namespace {

using semiglobal::kCensusReach;
using semiglobal::kDisparityMargin;
using semiglobal::kSmoothReach;
using semiglobal::SearchParams;

constexpr int kInputMargin = 32;                  // pixels on both sides of an input row
constexpr int kInputRows = 2 * kCensusReach + 2;  // that a grid row reads, and one more for its guide
constexpr int kCostRows = 2 * kSmoothReach + 2;   // that two grid rows are smoothed from
constexpr int kGuideRows = kCostRows;             // from the costs of a grid row until it is upsampled
constexpr int kRawRows = 4;                       // more than the 3×3 median reads
constexpr int kOutputRows = 12;                   // that the last push() of an image finishes

SearchParams params_for(const MatcherOptions& options, int width, int lanes) {
  SearchParams params{};
  params.width = width;
  params.min_disparity = options.min_disparity;
  params.disparities = options.disparities;
  params.vectors = (options.disparities + lanes - 1) / lanes;
  params.lanes = lanes;
  params.decimation_x = options.grid == Grid::kCoarse ? 2 : 1;
  params.gradient_limit = options.gradient_limit;
  params.p1 = options.p1;
  return params;
}

}  // namespace

SemiglobalMatcher::SemiglobalMatcher(const MatcherOptions& options, Size image)
    : options_(options),
      image_(image),
      kernel_(semiglobal::kernel_for(resolve_isa(options.isa))),
      params_(params_for(options, image.width, kernel_.lanes)),
      cost_stage_(kCensusReach, 2),
      path_stage_(kSmoothReach),
      median_stage_(options.median / 2),
      left_input_(params_.row_bytes(), kInputRows + kRowsAhead, kInputMargin),
      right_input_(params_.row_bytes(), kInputRows + kRowsAhead, kInputMargin),
      pixel_costs_(options_, params_, kernel_),
      costs_(params_.grid_width() * params_.sample_bytes(), kCostRows, params_.sample_bytes()),
      p2_(params_.grid_width() + kDisparityMargin, kCostRows),
      guide_(image.width + kDisparityMargin, kGuideRows),
      padding_(static_cast<std::size_t>(params_.sample_bytes())),
      smoothed_(params_.grid_width() * params_.sample_bytes(), 2),
      sums_(params_.grid_width() * params_.sample_bytes(), 2),
      winners_(params_.grid_width() + kDisparityMargin, 2),
      checks_(options_, params_, kernel_),
      raw_(params_.grid_width(), kRawRows, kDisparityMargin),
      median_(params_.grid_width(), 1, kDisparityMargin),
      upsampled_(image.width, 2, kDisparityMargin),
      interpolated_(image.width, 1, kDisparityMargin),
      output_rows_(image.width, kOutputRows, kDisparityMargin) {
  for (int k = options.disparities; k < params_.sample_bytes(); ++k) {
    padding_[static_cast<std::size_t>(params_.lane_offset(k))] = 255;
  }
}

RowRange SemiglobalMatcher::begin(RowRange rows) noexcept {
  output_ = rows;
  final_end_ = rows.first;
  const RowRange upsampled{rows.first / 2, std::min(rows.end / 2 + 1, grid_rows().end)};
  const RowRange raw = median_stage_.begin(upsampled, grid_rows());
  const RowRange costs = path_stage_.begin(raw, grid_rows());
  return cost_stage_.begin(costs, {0, image_.height});
}

RowRange SemiglobalMatcher::push(int y) noexcept {
  const int first_final = final_end_;
  pad_row(left_row(y));
  pad_row(right_row(y));
  while (cost_stage_.ready(y + 1)) {
    write_costs(cost_stage_.take());
    while (path_stage_.ready(cost_stage_.made_end(), 2)) match_two_rows();
  }
  return {first_final, final_end_};
}

void SemiglobalMatcher::pad_row(std::uint8_t* row) const noexcept {
  std::fill_n(row - kCensusReach, kCensusReach, row[0]);
  std::fill_n(row + image_.width, kCensusReach, row[image_.width - 1]);
}

semiglobal::PixelRows SemiglobalMatcher::pixel_rows(RowRing<std::uint8_t>& input, int y) const noexcept {
  semiglobal::PixelRows rows{};
  for (int dy = -kCensusReach; dy <= kCensusReach; ++dy) {
    rows.census[kCensusReach + dy] = input.row(clamped_row(y + dy, image_.height));
  }
  rows.above = input.row(mirrored_row(y - 1, image_.height));
  rows.row = input.row(y);
  rows.below = input.row(mirrored_row(y + 1, image_.height));
  return rows;
}

// Computes all that the later stages need of the input rows, which are overwritten soon after.
void SemiglobalMatcher::write_costs(int grid_y) noexcept {
  const int y = 2 * grid_y;
  pixel_costs_.write(pixel_rows(left_input_, y), pixel_rows(right_input_, y), costs_.row(grid_y));
  const auto left = [&](int row) { return left_row(std::min(row, image_.height - 1)); };
  kernel_.guide_row(left(y), left(y + 1), left(y + 2), image_.width, guide_.row(grid_y));
  kernel_.adapt_p2(left_row(y), params_.grid_width(), params_.decimation_x, options_.p2, p2_.row(grid_y));
}

// The last of an odd number of grid rows is matched together with a copy of itself, whose result is dropped.
void SemiglobalMatcher::match_two_rows() noexcept {
  const int first = path_stage_.made_end();
  const RowRange cost_rows = path_stage_.input();
  semiglobal::PathRows rows{};
  for (int i = 0; i < kCostRows; ++i) {
    rows.costs[i] = costs_.row(std::clamp(first - kSmoothReach + i, cost_rows.first, cost_rows.end - 1));
  }
  rows.padding = padding_.data();
  for (int i = 0; i < 2; ++i) {
    rows.p2[i] = p2_.row(std::min(first + i, path_stage_.end() - 1));
    rows.smoothed[i] = smoothed_.row(i);
    rows.sums[i] = sums_.row(i);
    rows.winners[i] = winners_.row(i);
  }
  kernel_.paths_from_right(params_, rows);
  kernel_.paths_from_left(params_, rows);
  for (int i = 0; i < 2 && path_stage_.made_end() < path_stage_.end(); ++i) {
    validate_row(path_stage_.take(), i);
    while (median_stage_.ready(path_stage_.made_end())) finish_grid_row(median_stage_.take());
  }
}

void SemiglobalMatcher::validate_row(int grid_y, int of_two) noexcept {
  checks_.write(sums_.row(of_two), winners_.row(of_two), row_with_holes(left_mask_, 2 * grid_y),
                row_with_holes(right_mask_, 2 * grid_y), raw_.row(grid_y));
}

void SemiglobalMatcher::finish_grid_row(int grid_y) noexcept {
  const int width = params_.grid_width();
  SubsampledDisparity* row = raw_.row(grid_y);
  if (options_.median > 0) {
    row = median_.row(0);
    if (grid_y == grid_rows().first || grid_y == grid_rows().end - 1) {
      std::copy_n(raw_.row(grid_y), width, row);
    } else {
      kernel_.median_row(raw_.row(grid_y - 1), raw_.row(grid_y), raw_.row(grid_y + 1), width,
                         options_.hole_filling, row);
    }
  }
  if (options_.hole_filling) semiglobal::fill_holes(row, width);
  upsample_row(grid_y, row);
}

// Writes the image row of a grid row and the one between it and the grid row before; after the last grid row
// also the image row below, if there is one.
void SemiglobalMatcher::upsample_row(int grid_y, SubsampledDisparity* row) noexcept {
  if (options_.grid == Grid::kCoarse) {
    kernel_.upsample_columns(row, image_.width, guide_.row(grid_y), upsampled_.row(grid_y));
  } else {
    std::copy_n(row, image_.width, upsampled_.row(grid_y));
  }
  const int y = 2 * grid_y;
  if (output_.contains(y - 1)) {
    kernel_.interpolate_rows(upsampled_.row(grid_y - 1), upsampled_.row(grid_y), image_.width,
                             guide_.row(grid_y - 1), interpolated_.row(0));
    write_row(y - 1, interpolated_.row(0));
  }
  if (output_.contains(y)) write_row(y, upsampled_.row(grid_y));
  if (grid_y == grid_rows().end - 1 && output_.contains(y + 1)) write_row(y + 1, upsampled_.row(grid_y));
}

void SemiglobalMatcher::write_row(int y, const SubsampledDisparity* row) noexcept {
  std::int16_t* const out = output_rows_.row(y);
  kernel_.write_disparities(
      row, image_.width,
      {options_.min_disparity, options_.disparities, options_.subpixel, options_.hole_filling}, out);
  mask_row(y, out);
  final_end_ = y + 1;
}

void SemiglobalMatcher::mask_row(int y, std::int16_t* out) const noexcept {
  if (const std::uint8_t* valid = row_with_holes(right_mask_, y)) {
    for (int x = 0; x < image_.width; ++x) {
      if (out[x] < 0) continue;
      const int whole = options_.subpixel ? (out[x] + kSubpixelUnits / 2) >> 4 : out[x];
      if (valid[x - whole] == 0) out[x] = options_.hole_filling ? as_filled(out[x]) : kInvalidDisparity;
    }
  }
  if (const std::uint8_t* valid = row_with_holes(left_mask_, y)) {
    for (int x = 0; x < image_.width; ++x) {
      if (valid[x] == 0) out[x] = kInvalidDisparity;
    }
  }
}

std::size_t SemiglobalMatcher::scratch_bytes() const noexcept {
  return left_input_.bytes() + right_input_.bytes() + pixel_costs_.scratch_bytes() + costs_.bytes() +
         p2_.bytes() + guide_.bytes() + padding_.size() + smoothed_.bytes() + sums_.bytes() +
         winners_.bytes() + checks_.scratch_bytes() + raw_.bytes() + median_.bytes() + upsampled_.bytes() +
         interpolated_.bytes() + output_rows_.bytes();
}

}  // namespace stereod
