// SPDX-License-Identifier: BSD-3-Clause
// From two cameras and their relative pose to a rectified pair.
#pragma once

#include "core/geometry/calibration.h"
#include "core/geometry/camera_model.h"

namespace stereod {

/// The pose of the right camera relative to the left one: point X of the left camera is rotation·X +
/// translation_m for the right one. So translation_m.x < 0 if the right camera stands on the right.
struct StereoPose {
  Matrix3 rotation;
  Vector3 translation_m;
};

/// Returns the axis of @p rotation, its length the angle [rad]: the inverse of rotation_about() for angles
/// below π.
Vector3 rotation_vector(const Matrix3& rotation);

/// Returns the rectified pair of two cameras with images of one size. Turns each camera by half of the
/// rotation between them, then both so that the line between them is their x axis (Bouguet's method, as in
/// OpenCV's stereoRectify). Both rectified images have the same projection with square pixels, and every
/// rectified pixel has a source. The field of view of a fisheye is limited so that the rectified focal length
/// is at least half of the camera's. Sets the id; leaves the quality empty.
/// @throws std::invalid_argument with a sentence if the cameras do not stand side by side, left and right are
/// swapped, or they are turned to each other by a right angle or more.
Calibration rectified_pair(const CameraModel& left, const CameraModel& right, const StereoPose& pose);

/// Returns @p calibration with new projections. @p alpha [0…1]: 0 shows only what every rectified pixel has a
/// source for, as rectified_pair() does; 1 shows all pixels of both cameras; between, the borders move in
/// proportion. Both images get the same projection with square pixels. Sets a new id.
/// @throws std::invalid_argument with a sentence if the two cameras see nothing in common.
Calibration with_alpha(const Calibration& calibration, double alpha);

/// Returns the pose of the right camera relative to the left one: the inverse of rectified_pair().
StereoPose stereo_pose(const Calibration& calibration);

}  // namespace stereod
