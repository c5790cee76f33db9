// SPDX-License-Identifier: BSD-3-Clause
// The calibration that the benchmarks of rectification use.
#pragma once

#include "core/geometry/calibration.h"
#include "core/geometry/camera_model.h"

namespace stereod::bench {

/// Returns the calibration of a webcam in a slightly rotated rig; the numbers are for 640×480.
inline CameraCalibration webcam_calibration(Size size) {
  CameraCalibration calibration;
  CameraModel& camera = calibration.camera;
  camera.image = size;
  camera.fx = camera.fy = 535;
  camera.cx = 327;
  camera.cy = 247;
  camera.k1 = -0.27;
  camera.k2 = 0.09;
  camera.p1 = 0.001;
  camera.p2 = -0.0008;
  calibration.rotation = rotation_about({0.012, -0.02, 0.008});
  calibration.projection = {500, 500, 320, 240};
  return calibration;
}

}  // namespace stereod::bench
