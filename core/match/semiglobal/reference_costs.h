// SPDX-License-Identifier: BSD-3-Clause
// Sections 2.1 and 2.2 of docs/matcher.md in plain code: from two images to sums of path costs.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/image.h"
#include "core/match/options.h"

namespace stereod::semiglobal {

/// Costs, or sums of costs along paths, of one pixel or sample: one for each k in [0, disparities).
using Costs = std::vector<int>;
using CostsOfRow = std::vector<Costs>;

/// Maximum of a sum along a path, and of two of them added.
inline constexpr int kMaxSum = 255;

inline std::size_t as_index(int i) { return static_cast<std::size_t>(i); }
int size_of(const auto& container) { return static_cast<int>(container.size()); }

/// A rectified pair, and where the samples of the grid lie in it. Borrows the images and the options.
struct SampledPair {
  SampledPair(GrayView left_image, GrayView right_image, const MatcherOptions& matcher_options)
      : left(left_image),
        right(right_image),
        options(matcher_options),
        decimation_x(matcher_options.grid == Grid::kCoarse ? 2 : 1),
        grid_width((left.width() + decimation_x - 1) / decimation_x),
        grid_height((left.height() + 1) / 2) {}

  int column(int grid_x) const { return grid_x * decimation_x; }
  static int image_row(int grid_y) { return 2 * grid_y; }
  /// Returns the column of the right image that column @p x matches with number @p k; below 0: outside.
  int match_of(int x, int k) const { return x - options.min_disparity - k; }
  /// Returns |gray value at (x, y) − gray value at (to_x, to_y)| of the left image, both clamped to the
  /// image.
  int gray_step(int x, int y, int to_x, int to_y) const;

  GrayView left, right;
  const MatcherOptions& options;
  int decimation_x;
  int grid_width, grid_height;
};

/// Returns the costs of every grid row, smoothed along x and then down the rows (section 2.1).
std::vector<CostsOfRow> smoothed_costs(const SampledPair& pair);

/// Returns the sums of both paths along grid row @p grid_y, from its smoothed costs (section 2.2).
CostsOfRow path_sums(const SampledPair& pair, const CostsOfRow& costs, int grid_y);

}  // namespace stereod::semiglobal
