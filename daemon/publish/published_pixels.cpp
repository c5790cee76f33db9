// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/published_pixels.h"

#include <algorithm>

#include "core/base/text.h"

namespace stereod {
namespace {

int published(int first, int count, int decimation, int side) {
  const int pixels = count > 0 ? count : side - first;
  return (pixels + decimation - 1) / decimation;
}

}  // namespace

PublishedPixels::PublishedPixels(const PublishConfig& publish, Size image)
    : left(publish.left),
      top(publish.top),
      decimation_x(publish.decimation_x),
      decimation_y(publish.decimation_y),
      width(published(publish.left, publish.width, publish.decimation_x, image.width)),
      height(published(publish.top, publish.height, publish.decimation_y, image.height)) {}

std::optional<std::string> region_problem(const PublishConfig& publish, Size image) {
  const auto outside = [](int first, int count, int side) { return first >= side || count > side - first; };
  if (!outside(publish.left, publish.width, image.width) &&
      !outside(publish.top, publish.height, image.height)) {
    return std::nullopt;
  }
  return "found " + to_string(Size{publish.width, publish.height}) + " px at column " +
         std::to_string(publish.left) + ", row " + std::to_string(publish.top) +
         " (0: up to the edge), allowed: a region inside the image of " + to_string(image) + " px";
}

ColumnRange columns_to_match(const MatcherOptions& options, Size image, ColumnRange wanted) {
  if (options.method == Method::kSemiglobal) return {0, image.width};
  // Half a window, the neighbor that the prefilter reads, and the neighbors that the median reads.
  const int margin = options.window / 2 + options.median / 2 + 1;
  const int max_disparity = options.min_disparity + options.disparities;
  // The match of a pixel is to its left. With the left-right check, matches of the match are to the right of
  // the pixel.
  const int right = options.left_right_max_diff >= 0 ? options.disparities : 0;
  return {std::max(wanted.first - max_disparity - margin, 0),
          std::min(wanted.end + right + margin, image.width)};
}

}  // namespace stereod
