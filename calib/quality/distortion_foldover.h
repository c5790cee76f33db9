// SPDX-License-Identifier: BSD-3-Clause
// Detects where a distortion model is not invertible.
#pragma once

#include "core/geometry/camera_model.h"

namespace stereod::calib {

/// Returns the share [0…1] of the image's pixels that no viewing direction maps to, because the distortion folds
/// the image over itself before it gets there. Directions of a fisheye lens at 90° and beyond do not count.
double distortion_foldover(const CameraModel& camera);

}  // namespace stereod::calib
