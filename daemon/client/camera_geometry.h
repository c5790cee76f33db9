// SPDX-License-Identifier: BSD-3-Clause
// The rectified camera: from disparities to depth and points.
#pragma once

#include <optional>

#include "stereod/camera_info_t.hpp"

namespace stereod {

/// A point [m]: x to the right, y down, z forward, origin at the left camera.
struct StereoPoint {
  float x = 0, y = 0, z = 0;
};

/// What depth needs to know of the rectified camera.
struct CameraGeometry {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  double baseline_m = 0;
  double disparity_offset = 0;  ///< px, added to a disparity before it is converted to depth

  /// Returns the distance along the optical axis [m]; infinite at the horizon and beyond.
  double depth_m(double disparity_px) const;
  /// Returns the point that pixel (@p x, @p y) of the rectified left image shows; not finite where the depth is not.
  StereoPoint point(double x, double y, double disparity_px) const;
};

/// Returns the geometry in @p info; empty if it is uncalibrated or its numbers are out of range.
std::optional<CameraGeometry> geometry_of(const camera_info_t& info);

/// The published pixels in the rectified image: pixel (u, v) of the published image is pixel (image_x(u), image_y(v)) of
/// the rectified image.
struct PixelGrid {
  int left = 0, top = 0;                   ///< px
  int decimation_x = 1, decimation_y = 1;  ///< px, ≥ 1

  int image_x(int u) const { return left + u * decimation_x; }
  int image_y(int v) const { return top + v * decimation_y; }
  friend bool operator==(const PixelGrid& a, const PixelGrid& b) {
    return a.left == b.left && a.top == b.top && a.decimation_x == b.decimation_x &&
           a.decimation_y == b.decimation_y;
  }
};

}  // namespace stereod
