#include "calib/quality/distortion_foldover.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace stereod {

namespace {

// How far from the center, in normalized coordinates, a fisheye's image gets before it turns back; infinite
// if it does not below a right angle.
double fisheye_reach(const CameraModel& camera) {
  constexpr int kSteps = 900;  // a tenth of a degree
  double reach = 0;
  for (int step = 1; step < kSteps; ++step) {
    const double theta = std::numbers::pi / 2 * step / kSteps;
    const double bent = camera.distort({std::tan(theta), 0}).x;
    if (!(bent > reach)) return reach;
    reach = bent;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double distortion_foldover(const CameraModel& camera) {
  const bool fisheye = camera.lens == LensModel::kFisheye;
  const double reach = fisheye ? fisheye_reach(camera) : 0;
  constexpr int kSteps = 40;
  int without = 0;
  for (int row = 0; row <= kSteps; ++row) {
    for (int column = 0; column <= kSteps; ++column) {
      const Point2 bent = camera.from_pixel({static_cast<double>(camera.image.width - 1) * column / kSteps,
                                             static_cast<double>(camera.image.height - 1) * row / kSteps});
      const bool seen = fisheye ? std::hypot(bent.x, bent.y) <= reach : camera.undistort(bent).has_value();
      without += seen ? 0 : 1;
    }
  }
  return static_cast<double>(without) / ((kSteps + 1) * (kSteps + 1));
}

}  // namespace stereod
