// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client/camera_geometry.h"

#include <cmath>
#include <limits>

namespace stereod {

double CameraGeometry::depth_m(double disparity_px) const {
  const double shift = disparity_px + disparity_offset;
  return shift > 0 ? fx * baseline_m / shift : std::numeric_limits<double>::infinity();
}

StereoPoint CameraGeometry::point(double x, double y, double disparity_px) const {
  const double z = depth_m(disparity_px);
  return {static_cast<float>((x - cx) * z / fx), static_cast<float>((y - cy) * z / fy),
          static_cast<float>(z)};
}

std::optional<CameraGeometry> geometry_of(const camera_info_t& m) {
  const bool finite = std::isfinite(m.fx) && std::isfinite(m.fy) && std::isfinite(m.cx) &&
                      std::isfinite(m.cy) && std::isfinite(m.baseline_m) && std::isfinite(m.disparity_offset);
  if (m.calibrated == 0 || !finite || m.fx <= 0 || m.fy <= 0 || m.baseline_m <= 0) return std::nullopt;
  return CameraGeometry{m.fx, m.fy, m.cx, m.cy, m.baseline_m, m.disparity_offset};
}

}  // namespace stereod
