// What a calibrated pair of cameras is.
#pragma once

#include <optional>
#include <string>

#include "core/base/image.h"
#include "core/base/limits.h"
#include "core/geometry/camera_model.h"

namespace stereod {

/// The pinhole camera that a rectified image seems to be taken with; all in pixels.
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

/// Where a point of the rectified image lies in the camera's own one; both in pixels, perhaps outside.
/// Nothing if it is not in front of the camera.
std::optional<Point2> source_point(const CameraCalibration& camera, Point2 rectified);

/// The inverse. Nothing where CameraModel::undistort() finds nothing, or not in front of the rectified
/// camera.
std::optional<Point2> rectified_point(const CameraCalibration& camera, Point2 source);

/// How good a calibration is.
struct CalibrationQuality {
  int pairs_used = 0;
  double rms_px = 0;             ///< reprojection error over the pairs used
  double epipolar_error_px = 0;  ///< mean difference of rows of a point in the rectified images
  friend bool operator==(const CalibrationQuality&, const CalibrationQuality&) = default;
};

/// A stereo pair whose rectified images have aligned rows: both projections share fx, fy and cy, and the
/// right camera lies `baseline_m` meters along the x axis of the rectified left one.
struct Calibration {
  Size image;  ///< of the source images and of the rectified ones
  CameraCalibration left, right;
  double baseline_m = 0;
  std::string id;  ///< see calibration_id()
  CalibrationQuality quality;
  friend bool operator==(const Calibration&, const Calibration&) = default;
};

// The ranges of a sound calibration: wide enough for any camera, narrow enough to catch a number in the wrong
// place or unit. Principal points are as far off as focal lengths are long at most.
inline constexpr double kMinFocal_px = 1, kMaxFocal_px = 1e6;
inline constexpr double kMinBaseline_m = 1e-4, kMaxBaseline_m = 100;
inline constexpr double kMaxError_px = 1e6;
inline constexpr int kMaxPairs = 1'000'000;

/// Whether the rows are orthonormal to 1e-6 and the determinant is +1.
bool is_rotation(const Matrix3& matrix);

/// What makes one camera unusable, as problem_with() has it; `name` is left or right.
std::optional<std::string> problem_with_camera(const std::string& name, const CameraModel& camera);
std::optional<std::string> problem_with_camera(const std::string& name, const CameraCalibration& camera);

/// A complaint if next to nothing of what the cameras see is in the rectified images: numbers each of which
/// could be, but together those of no camera. For a calibration that problem_with() finds nothing in.
std::optional<std::string> problem_with_view(const Calibration& calibration);

/// What makes `calibration` unusable, as one sentence that names the place; nothing if it is sound: every
/// number finite and in its range, sizes equal, rotations that are rotations, projections that align rows.
std::optional<std::string> problem_with(const Calibration& calibration);

/// 16 hexadecimal digits that change when any number of the geometry does (FNV-1a, 64 bit, over the numbers
/// and lens models of both cameras, the size and the baseline; not the quality).
std::string calibration_id(const Calibration& calibration);

}  // namespace stereod
