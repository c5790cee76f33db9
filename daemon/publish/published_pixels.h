// Which pixels of the rectified image are published, and what has to be matched for them.
#pragma once

#include <optional>
#include <string>

#include "core/base/image.h"
#include "core/match/options.h"
#include "daemon/config/config.h"

namespace stereod {

/// Pixel (u, v) of what is published is pixel (left + u·decimation_x, top + v·decimation_y) of the rectified
/// image.
struct PublishedPixels {
  int left = 0, top = 0;
  int decimation_x = 1, decimation_y = 1;
  int width = 0, height = 0;  ///< how many columns and rows are published

  /// Those that the configuration asks for; region_problem() found nothing wrong with it.
  PublishedPixels(const PublishConfig& publish, Size image);
  /// All of an image.
  explicit PublishedPixels(Size image) : PublishedPixels(PublishConfig(), image) {}

  Size size() const { return {width, height}; }
  /// In the rectified image, from the first published one to the last.
  ColumnRange columns() const { return {left, left + (width - 1) * decimation_x + 1}; }
  RowRange rows() const { return {top, top + (height - 1) * decimation_y + 1}; }
};

/// Why images of this size have no such region, as a sentence; nothing if they have.
std::optional<std::string> region_problem(const PublishConfig& publish, Size image);

/// The columns that have to be matched so that `wanted` get the answers that they would get in the whole
/// image: those that windows, filters and the search for matches look at; for the semi-global matcher all.
ColumnRange columns_to_match(const MatcherOptions& options, Size image, ColumnRange wanted);

}  // namespace stereod
