// SPDX-License-Identifier: BSD-3-Clause
// Draws the scale bar beside disparities.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "daemon/visual/disparity_rendering.h"

namespace stereod {

/// A labeled position on the bar; nearness 0 is the lower end, 1 the upper end.
struct ScaleTick {
  double nearness = 0;
  std::string label;
};

/// Returns round disparities, evenly spaced, at least @p min_gap apart [fraction of the bar, > 0].
std::vector<ScaleTick> disparity_ticks(const DisparityRange& range, double min_gap);

/// Returns round depths [m], the roundest first, at least @p min_gap apart.
std::vector<ScaleTick> depth_ticks(const DisparityRange& range, const DepthScale& scale, double min_gap);

/// Returns the scale bar as an image of @p height rows [≥ 60]; in meters with a depth scale, else in pixels.
ColorImage draw_scale_bar(int height, const DisparityRange& range, const std::optional<DepthScale>& depth);

/// Returns @p width rounded up to 1, 2 or 5 times a power of ten.
double round_step(double width);

}  // namespace stereod
