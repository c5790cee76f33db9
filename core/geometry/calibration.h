// SPDX-License-Identifier: BSD-3-Clause
// A calibrated pair of cameras.
#pragma once

#include <optional>
#include <string>

#include "core/base/image.h"
#include "core/base/limits.h"
#include "core/geometry/camera_model.h"

namespace stereod {

/// The pinhole camera of a rectified image [px].
struct RectifiedProjection {
  double fx = 0, fy = 0;
  double cx = 0, cy = 0;
  friend bool operator==(const RectifiedProjection&, const RectifiedProjection&) = default;
};

/// One camera of the pair. `rotation` turns directions of the camera into directions of the rectified camera.
struct CameraCalibration {
  CameraModel camera;
  Matrix3 rotation;
  RectifiedProjection projection;
  friend bool operator==(const CameraCalibration&, const CameraCalibration&) = default;
};

/// Returns where point @p rectified [px] of the rectified image lies in the camera image [px, possibly
/// outside it], or nullopt if it is not in front of the camera.
std::optional<Point2> source_point(const CameraCalibration& camera, Point2 rectified);

/// The inverse of source_point(). Returns nullopt where CameraModel::undistort() does, or if the point is not
/// in front of the rectified camera.
std::optional<Point2> rectified_point(const CameraCalibration& camera, Point2 source);

/// How good a calibration is.
struct CalibrationQuality {
  int pairs_used = 0;
  double rms_px = 0;             ///< reprojection error of the pairs used
  double epipolar_error_px = 0;  ///< mean row difference of a point in the rectified images
  friend bool operator==(const CalibrationQuality&, const CalibrationQuality&) = default;
};

/// A stereo pair whose rectified images have aligned rows: both projections share fx, fy and cy, and the
/// right camera lies at `baseline_m` on the x axis of the rectified left one.
struct Calibration {
  Size image;  ///< of the source images and of the rectified ones
  CameraCalibration left, right;
  double baseline_m = 0;
  std::string id;  ///< see calibration_id()
  CalibrationQuality quality;
  friend bool operator==(const Calibration&, const Calibration&) = default;
};

// The ranges of a valid calibration: wide enough for any camera, narrow enough to catch a number in the wrong
// place or unit. Principal points lie within ±kMaxFocal_px.
inline constexpr double kMinFocal_px = 1, kMaxFocal_px = 1e6;
inline constexpr double kMinBaseline_m = 1e-4, kMaxBaseline_m = 100;
inline constexpr double kMaxError_px = 1e6;
inline constexpr int kMaxPairs = 1'000'000;

/// Returns whether the rows of @p matrix are orthonormal to 1e-6 and its determinant is +1.
bool is_rotation(const Matrix3& matrix);

/// Return what makes one camera unusable, as problem_with() does, or nullopt. @p name is "left" or "right".
std::optional<std::string> problem_with_camera(const std::string& name, const CameraModel& camera);
std::optional<std::string> problem_with_camera(const std::string& name, const CameraCalibration& camera);

/// Returns a sentence if less than 5 % of the pixels of a rectified image have a source in the camera image,
/// else nullopt: each number is in its range, but no camera has all of them. problem_with(@p calibration)
/// must be nullopt.
std::optional<std::string> problem_with_view(const Calibration& calibration);

/// Returns what makes @p calibration unusable, as one sentence that names the number, or nullopt if it is
/// valid: every number is finite and in its range, the sizes are equal, is_rotation() holds, and the
/// projections align the rows.
std::optional<std::string> problem_with(const Calibration& calibration);

/// Returns 16 hexadecimal digits that change when any number of the geometry changes: FNV-1a, 64 bit, over
/// the numbers and lens models of both cameras, the size and the baseline, but not the quality.
std::string calibration_id(const Calibration& calibration);

}  // namespace stereod
