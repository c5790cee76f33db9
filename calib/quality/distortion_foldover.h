// Where a lens model does what no lens does.
#pragma once

#include "core/geometry/camera_model.h"

namespace stereod {

/// The share of the image's pixels, 0 … 1, that no direction belongs to because the distortion folds the
/// image over itself before it gets there. What a fisheye sees at a right angle and beyond is no fault.
double distortion_foldover(const CameraModel& camera);

}  // namespace stereod
