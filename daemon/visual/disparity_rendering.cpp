// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/visual/disparity_rendering.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "daemon/visual/scale_bar.h"

namespace stereod {

namespace {

constexpr int kMinRowsWithScaleBar = 60;
constexpr std::size_t kValues = std::size_t{std::numeric_limits<std::int16_t>::max()} + 1;

/// Returns the smallest value that at least @p share of all counted values do not exceed.
int percentile(const std::vector<std::int64_t>& histogram, std::int64_t total, double share) {
  const auto wanted = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(total)));
  std::int64_t seen = 0;
  std::size_t value = 0;
  while (value + 1 < histogram.size() && (seen += histogram[value]) < wanted) ++value;
  return static_cast<int>(value);
}

/// Returns the color of every 16-bit disparity.
std::vector<Rgb> color_table(const DisparityRange& range, int units_per_pixel) {
  std::vector<Rgb> colors(kValues);
  for (std::size_t value = 0; value < kValues; ++value) {
    const double pixels = static_cast<double>(value) / units_per_pixel;
    colors[value] = nearness_color((pixels - range.far_px) / (range.near_px - range.far_px));
  }
  return colors;
}

void check(const DisparityRange& range, const DisparityRenderingOptions& options) {
  if (!(std::isfinite(range.far_px) && std::isfinite(range.near_px) && range.far_px < range.near_px)) {
    throw std::invalid_argument("the range of disparities to draw is empty: far_px must be below near_px");
  }
  if (options.depth && !(std::isfinite(options.depth->focal_baseline) && options.depth->focal_baseline > 0 &&
                         std::isfinite(options.depth->offset_px))) {
    throw std::invalid_argument("a scale bar in meters needs a focal length and a baseline above 0");
  }
}

}  // namespace

DisparityRange typical_range(DisparityView disparity, int units_per_pixel) {
  std::vector<std::int64_t> histogram(kValues);
  std::int64_t total = 0;
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) {
      if (disparity.at(x, y) < 0) continue;
      ++histogram[static_cast<std::size_t>(disparity.at(x, y))];
      ++total;
    }
  }
  if (total == 0) return {0, 1};
  const double low = static_cast<double>(percentile(histogram, total, 0.02)) / units_per_pixel;
  const double high = static_cast<double>(percentile(histogram, total, 0.98)) / units_per_pixel;
  const double step = high > low ? round_step((high - low) / 20) : 1;
  const DisparityRange range{std::floor(low / step) * step, std::ceil(high / step) * step};
  return range.far_px < range.near_px ? range : DisparityRange{range.far_px, range.far_px + 1};
}

ColorImage draw_disparity(DisparityView disparity, int units_per_pixel,
                          const DisparityRenderingOptions& options) {
  const DisparityRange range = options.range ? *options.range : typical_range(disparity, units_per_pixel);
  check(range, options);
  ColorImage legend;
  if (options.scale_bar && disparity.height() >= kMinRowsWithScaleBar) {
    legend = draw_scale_bar(disparity.height(), range, options.depth);
  }

  const std::vector<Rgb> colors = color_table(range, units_per_pixel);
  ColorImage image(disparity.width() + legend.width(), disparity.height());
  for (int y = 0; y < disparity.height(); ++y) {
    std::transform(disparity.row(y), disparity.row(y) + disparity.width(), image.row(y),
                   [&](std::int16_t value) {
                     return value < 0 ? kUnmatchedColor : colors[static_cast<std::size_t>(value)];
                   });
    if (!legend.empty()) std::copy_n(legend.row(y), legend.width(), image.row(y) + disparity.width());
  }
  return image;
}

}  // namespace stereod
