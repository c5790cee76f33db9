// Images as a calibration rectifies them, smoothly: for looking at and measuring in, not for matching fast.
#pragma once

#include "core/base/image.h"
#include "core/geometry/calibration.h"

namespace stereod {

/// Interpolates between the four nearest pixels; black where there is no source. The image has the size of
/// the calibration's images.
GrayImage rectified_view(const CameraCalibration& camera, GrayView picture);

}  // namespace stereod
