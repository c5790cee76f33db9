// Pictures as a calibration rectifies them, smoothly: for looking at and measuring in, not for matching fast.
#pragma once

#include "core/calibration.h"
#include "core/image.h"

namespace stereod {

/// Interpolates between the four nearest pixels; black where there is no source. The picture has the size of
/// the calibration's images.
GreyImage rectified_view(const CameraCalibration& camera, GreyView picture);

}  // namespace stereod
