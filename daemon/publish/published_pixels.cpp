#include "daemon/publish/published_pixels.h"

#include <algorithm>

#include "core/base/text.h"

namespace stereod {
namespace {

int published(int first, int count, int step, int side) {
  const int pixels = count > 0 ? count : side - first;
  return (pixels + step - 1) / step;
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
  const auto numbers = [](int width, int height, int left, int top) {
    return to_string(Size{width, height}) + " pixels from column " + std::to_string(left) + ", row " +
           std::to_string(top) + " on";
  };
  return "found " + numbers(publish.width, publish.height, publish.left, publish.top) +
         " (0: up to the edge), but the images are " + to_string(image) + "; allowed is what lies in them";
}

ColumnRange columns_to_match(const MatcherOptions& options, Size image, ColumnRange wanted) {
  // The paths of the semi-global one go along whole rows.
  if (options.method == Method::kSemiglobal) return {0, image.width};
  // A window, the pixels beside it that the prefilter looks at, and the neighbors of the median.
  const int around = options.window / 2 + options.median / 2 + 1;
  const int farthest = options.min_disparity + options.disparities;
  // A pixel's match is to the left of it; the match's own match may be to the right of the pixel.
  const int right = options.left_right_max_diff >= 0 ? options.disparities : 0;
  return {std::max(wanted.first - farthest - around, 0), std::min(wanted.end + right + around, image.width)};
}

}  // namespace stereod
