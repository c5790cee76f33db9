// SPDX-License-Identifier: BSD-3-Clause
// Rectifies whole images for display and measurement.
#pragma once

#include "core/base/image.h"
#include "core/geometry/calibration.h"

namespace stereod::calib {

/// Returns @p image rectified with bilinear interpolation and unrounded coordinates. Black where the source lies
/// outside the image. Slower than the daemon's RectifyMap.
GrayImage rectified_view(const CameraCalibration& camera, GrayView image);

}  // namespace stereod::calib
