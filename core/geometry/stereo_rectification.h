// From two cameras and how they stand to each other to a rectified pair.
#pragma once

#include "core/geometry/calibration.h"
#include "core/geometry/camera_model.h"

namespace stereod {

/// How the right camera stands to the left one: a point X of the left camera is rotation·X + translation_m
/// for the right one. So translation_m.x < 0 for a right camera that is to the right.
struct StereoPose {
  Matrix3 rotation;
  Vector3 translation_m;
};

/// The direction of a rotation's axis, its length the angle in radians: the inverse of rotation_about() for
/// angles below π.
Vector3 rotation_vector(const Matrix3& rotation);

/// Turns both cameras by half of what is between them, then so that the line between them is their x axis
/// (Bouguet's method, as in OpenCV's stereoRectify). The rectified images have square pixels, the same
/// projection in both, and show only what both cameras have pixels for; a fisheye's field of view is cut so
/// that the rectified focal length is at least half of the camera's. Images of one size; the quality is left
/// empty, the id is set. Throws std::invalid_argument with a sentence where the cameras do not stand side by
/// side, left one left, turned less than a right angle to each other.
Calibration rectified_pair(const CameraModel& left, const CameraModel& right, const StereoPose& pose);

/// The same cameras and rotations, but another part of what they see in the rectified images: `zoom` 0 only
/// what both cameras have pixels for, so that every rectified pixel has a source, as rectified_pair() has it;
/// 1 all pixels of both; between, the borders move in equal steps. Both images get the same projection, with
/// square pixels, and the result a new id. Throws std::invalid_argument with a sentence where the two cameras
/// see nothing in common.
Calibration with_alpha(const Calibration& calibration, double zoom);

/// The inverse of rectified_pair(): how the right camera of a rectified pair stands to the left one.
StereoPose stereo_pose(const Calibration& calibration);

}  // namespace stereod
