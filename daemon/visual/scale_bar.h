// The legend beside a disparity image.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "daemon/visual/disparity_rendering.h"

namespace stereod {

/// A labelled place on the bar; nearness 0 is its lower end, 1 its upper.
struct ScaleTick {
  double nearness = 0;
  std::string label;
};

/// Round disparities, evenly spaced, no closer to each other than `least_gap` (a part of the bar, > 0).
std::vector<ScaleTick> disparity_ticks(const DisparityRange& range, double least_gap);

/// Round depths in meters, the roundest first, wherever they keep `least_gap` from each other.
std::vector<ScaleTick> depth_ticks(const DisparityRange& range, const DepthScale& scale, double least_gap);

/// The legend as a image of its own, `height` rows high (≥ 60); in meters if there is a depth scale.
ColorImage draw_scale_bar(int height, const DisparityRange& range, const std::optional<DepthScale>& depth);

/// `width` rounded up to 1, 2 or 5 times a power of ten.
double round_step(double width);

}  // namespace stereod
