// SPDX-License-Identifier: BSD-3-Clause
// Exact disparities of a floor with posts, for tests of the obstacle scan.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/match/disparity.h"
#include "core/perception/obstacle_scan.h"

namespace stereod {

/// An upright board that faces the camera [m over the ground], `forward` of the camera and to the `left` of
/// it.
struct Post {
  double forward, left, half_width, bottom, top;
};

inline ScanGeometry floor_camera(Size size = {320, 240}) {
  ScanGeometry camera;
  camera.size = size;
  camera.fx = camera.fy = 0.8 * size.width;
  camera.cx = (size.width - 1) / 2.0;
  camera.cy = (size.height - 1) / 2.0;
  camera.baseline_m = 0.12;
  camera.units_per_pixel = 16;
  camera.disparities = 96;
  return camera;
}

/// Returns what the camera sees, rounded to units; kInvalidDisparity above the horizon and beyond the range
/// of disparities.
inline DisparityImage floor_disparity(const ScanGeometry& camera, const GroundPlane& ground,
                                      const std::vector<Post>& posts) {
  DisparityImage image(camera.size);
  const double sin = std::sin(ground.pitch_rad), cos = std::cos(ground.pitch_rad);
  for (int y = 0; y < camera.size.height; ++y) {
    const double v = (y - camera.cy) / camera.fy;
    const double down = v * cos + sin, forward = cos - v * sin;  // of a ray with z = 1
    for (int x = 0; x < camera.size.width; ++x) {
      const double left = (camera.cx - x) / camera.fx;
      double z = down > 0 ? ground.height_m / down : std::numeric_limits<double>::infinity();
      for (const Post& post : posts) {
        const double post_z = post.forward / forward;
        const double height = ground.height_m - post_z * down;
        if (std::abs(post_z * left - post.left) > post.half_width || height < post.bottom ||
            height > post.top)
          continue;
        z = std::min(z, post_z);
      }
      const double px = camera.fx * camera.baseline_m / z - camera.disparity_offset;
      const bool seen =
          std::isfinite(z) && px >= camera.min_disparity && px < camera.min_disparity + camera.disparities;
      image.at(x, y) =
          seen ? static_cast<std::int16_t>(std::lround(px * camera.units_per_pixel)) : kInvalidDisparity;
    }
  }
  return image;
}

/// Returns the scan of a whole image.
inline ScanResult scan_of(ObstacleScan& scan, const DisparityImage& image) {
  for (int y = 0; y < image.height(); ++y) scan.add_row(y, image.row(y));
  return scan.finish();
}

}  // namespace stereod
