// SPDX-License-Identifier: BSD-3-Clause
// The pixels of the rectified image that are published, and the columns to match for them.
#pragma once

#include <optional>
#include <string>

#include "core/base/image.h"
#include "core/match/options.h"
#include "daemon/config/config.h"

namespace stereod {

/// The published image: its pixel (u, v) is pixel (left + u·decimation_x, top + v·decimation_y) of the
/// rectified image.
struct PublishedPixels {
  int left = 0, top = 0;                   ///< [px of the rectified image]
  int decimation_x = 1, decimation_y = 1;  ///< [px of the rectified image, ≥ 1]
  int width = 0, height = 0;               ///< of the published image [px]

  /// Returns the pixels that the configuration selects. region_problem() must have returned nothing.
  PublishedPixels(const PublishConfig& publish, Size image);
  /// Returns all pixels of an image.
  explicit PublishedPixels(Size image) : PublishedPixels(PublishConfig(), image) {}

  Size size() const { return {width, height}; }
  /// Returns the columns of the rectified image from the first published one to the last.
  ColumnRange columns() const { return {left, left + (width - 1) * decimation_x + 1}; }
  /// Returns the rows of the rectified image from the first published one to the last.
  RowRange rows() const { return {top, top + (height - 1) * decimation_y + 1}; }
};

/// Returns why the configured region does not lie in images of this size: what was found, what is allowed.
/// Returns nothing if it does.
std::optional<std::string> region_problem(const PublishConfig& publish, Size image);

/// Returns the columns to match so that the @p wanted columns get the disparities of a match of the whole
/// image: the columns that their windows, filters and searches read. The semi-global matcher needs all
/// columns.
ColumnRange columns_to_match(const MatcherOptions& options, Size image, ColumnRange wanted);

}  // namespace stereod
