// SPDX-License-Identifier: BSD-3-Clause
#include "calib/quality/distortion_foldover.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace stereod::calib {

namespace {

// Returns the distance from the center, in normalized coordinates, at which a fisheye's image folds over;
// infinity if it does not below 90°.
double max_fisheye_radius(const CameraModel& camera) {
  constexpr int kSteps = 900;  // a tenth of a degree
  double radius = 0;
  for (int step = 1; step < kSteps; ++step) {
    const double theta = std::numbers::pi / 2 * step / kSteps;
    const double distorted = camera.distort({std::tan(theta), 0}).x;
    if (!(distorted > radius)) return radius;
    radius = distorted;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double distortion_foldover(const CameraModel& camera) {
  const bool fisheye = camera.lens == LensModel::kFisheye;
  const double max_radius = fisheye ? max_fisheye_radius(camera) : 0;
  constexpr int kSteps = 40;
  int unmapped = 0;
  for (int row = 0; row <= kSteps; ++row) {
    for (int column = 0; column <= kSteps; ++column) {
      const Point2 distorted =
          camera.from_pixel({static_cast<double>(camera.image.width - 1) * column / kSteps,
                             static_cast<double>(camera.image.height - 1) * row / kSteps});
      const bool mapped = fisheye ? std::hypot(distorted.x, distorted.y) <= max_radius
                                  : camera.undistort(distorted).has_value();
      unmapped += mapped ? 0 : 1;
    }
  }
  return static_cast<double>(unmapped) / ((kSteps + 1) * (kSteps + 1));
}

}  // namespace stereod::calib
