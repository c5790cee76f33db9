// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/visual/scale_bar.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/text.h"
#include "daemon/visual/color_map.h"
#include "daemon/visual/tiny_font.h"

namespace stereod {

namespace {

constexpr Rgb kBackground{20, 20, 22};
constexpr Rgb kTextColor{214, 214, 218};
constexpr Rgb kTickColor{150, 150, 156};

void fill(ImageView<Rgb> image, int x, int y, int width, int height, Rgb color) {
  for (int row = y; row < y + height; ++row) std::fill_n(image.row(row) + x, width, color);
}

}  // namespace

double round_step(double width) {
  const double power = std::pow(10, std::floor(std::log10(width)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= width * 0.999999) return factor * power;
  }
  return 10 * power;
}

std::vector<ScaleTick> disparity_ticks(const DisparityRange& range, double min_gap) {
  const double span = range.near_px - range.far_px;
  const double step = round_step(span * min_gap);
  std::vector<ScaleTick> ticks;
  for (double number = std::ceil(range.far_px / step - 1e-6); number * step <= range.near_px + 1e-6 * span;
       ++number) {
    const double disparity = number == 0 ? 0 : number * step;  // not −0
    ticks.push_back({(disparity - range.far_px) / span, significant(disparity)});
  }
  return ticks;
}

std::vector<ScaleTick> depth_ticks(const DisparityRange& range, const DepthScale& scale, double min_gap) {
  static constexpr std::array<std::array<double, 3>, 5> kRoundestFirst{
      {{1, 1, 1}, {2, 5, 5}, {1.5, 3, 7}, {2.5, 4, 6}, {1.2, 3.5, 8}}};
  const double span = range.near_px - range.far_px;
  std::vector<ScaleTick> ticks;
  for (const auto& factors : kRoundestFirst) {
    for (int exponent = -3; exponent <= 4; ++exponent) {
      for (const double factor : factors) {
        const double depth = factor * std::pow(10, exponent);
        const double nearness = (scale.focal_baseline / depth - scale.offset_px - range.far_px) / span;
        if (!(nearness >= 0 && nearness <= 1)) continue;
        const bool crowded = std::any_of(ticks.begin(), ticks.end(), [&](const ScaleTick& other) {
          return std::abs(other.nearness - nearness) < min_gap;
        });
        if (!crowded) ticks.push_back({nearness, significant(depth)});
      }
    }
  }
  return ticks;
}

ColorImage draw_scale_bar(int height, const DisparityRange& range, const std::optional<DepthScale>& depth) {
  const int zoom = std::clamp(height / 300, 1, 6);
  const int margin = 8 * zoom;
  const int bar_width = 12 * zoom;
  const int tick_length = 4 * zoom;
  const int letter_height = kLetterHeight * zoom;
  const int bar_top = margin + 2 * letter_height;  // below the unit
  const int bar_height = height - bar_top - margin;
  const double min_gap = 2.4 * letter_height / bar_height;

  const std::vector<ScaleTick> ticks =
      depth ? depth_ticks(range, *depth, min_gap) : disparity_ticks(range, min_gap);
  const std::string unit = depth ? "m" : "px";
  int label_width = 0;
  for (const ScaleTick& tick : ticks) label_width = std::max(label_width, text_width(tick.label, zoom));
  const int label_x = margin + bar_width + tick_length + 2 * zoom;
  ColorImage legend(std::max(label_x + label_width, margin + text_width(unit, zoom)) + margin, height);

  fill(legend.view(), 0, 0, legend.width(), height, kBackground);
  draw_text(legend.view(), margin, margin, unit, kTextColor, zoom);
  for (int row = 0; row < bar_height; ++row) {
    const Rgb color = nearness_color(1 - (row + 0.5) / bar_height);
    fill(legend.view(), margin, bar_top + row, bar_width, 1, color);
  }
  for (const ScaleTick& tick : ticks) {
    const int y = bar_top + static_cast<int>(std::lround((1 - tick.nearness) * (bar_height - zoom)));
    fill(legend.view(), margin + bar_width, y, tick_length, zoom, kTickColor);
    draw_text(legend.view(), label_x, y - letter_height / 2 + zoom / 2, tick.label, kTextColor, zoom);
  }
  return legend;
}

}  // namespace stereod
