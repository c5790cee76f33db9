// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client/stereo_frame.h"

#include <cmath>
#include <limits>

namespace stereod {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

}  // namespace

float StereoFrame::disparity_px(int x, int y, Pixels pixels) const {
  std::int16_t value = disparity.at(x, y);
  if (value == DisparityMap::kNone && pixels == Pixels::kMeasuredOrFilled && filled.width() > 0) {
    value = filled.at(x, y);
  }
  return value == DisparityMap::kNone ? kNoNumber
                                      : static_cast<float>(value) / static_cast<float>(units_per_pixel);
}

float StereoFrame::depth_m(int x, int y, Pixels pixels) const {
  const float px = disparity_px(x, y, pixels);
  if (std::isnan(px) || !camera) return kNoNumber;
  return static_cast<float>(camera->depth_m(static_cast<double>(px)));
}

StereoPoint StereoFrame::point(int x, int y, Pixels pixels) const {
  const float z = depth_m(x, y, pixels);
  if (!std::isfinite(z)) return {kNoNumber, kNoNumber, kNoNumber};
  return camera->point(grid.image_x(x), grid.image_y(y), static_cast<double>(disparity_px(x, y, pixels)));
}

std::vector<float> StereoFrame::depths_m(Pixels pixels) const {
  std::vector<float> depths;
  depths.reserve(static_cast<std::size_t>(disparity.width()) * static_cast<std::size_t>(disparity.height()));
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) depths.push_back(depth_m(x, y, pixels));
  }
  return depths;
}

std::vector<StereoPoint> StereoFrame::points(int step, Pixels pixels) const {
  std::vector<StereoPoint> points;
  for (int y = 0; y < disparity.height(); y += step) {
    for (int x = 0; x < disparity.width(); x += step) {
      const StereoPoint candidate = point(x, y, pixels);
      if (std::isfinite(candidate.z)) points.push_back(candidate);
    }
  }
  return points;
}

}  // namespace stereod
