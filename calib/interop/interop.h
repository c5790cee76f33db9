// Calibrations of other programs, in and out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/calibration.h"

namespace stereod {

/// They throw FileError with one sentence: what is missing or wrong, where. What is read is sound
/// (problem_with() finds nothing, the lens models fold next to nothing) and has its id. A rotation that was
/// written with so few digits that it is none to 1e-6 is made exact; all other numbers stay as they are.

/// ROS: one camera_info YAML for each camera, as camera_calibration writes them.
Calibration read_ros(const std::filesystem::path& left, const std::filesystem::path& right);
/// Written by us, they read back to the bit: what ROS has no place for is in an extra map `stereod`, which
/// ROS does not look at.
void write_ros(const std::filesystem::path& left, const std::filesystem::path& right,
               const Calibration& calibration);

/// Kalibr: a camchain with cam0, the left camera, and cam1. It holds no rectification; ours is added.
Calibration read_kalibr(const std::filesystem::path& camchain);

/// What OpenCV's files do not say themselves.
struct OpenCvHints {
  Size image;            ///< 0×0: the file says it, as ours do
  double unit_m = 1;     ///< what a length of 1 in them is, meters
  bool fisheye = false;  ///< D1 and D2 are of the fisheye model
};
/// OpenCV FileStorage (.yml, .xml or .json), as its sample stereo_calib writes: M1, D1, M2, D2; R, T and, if
/// there, R1, R2, P1, P2.
Calibration read_opencv(const std::filesystem::path& intrinsics, const std::filesystem::path& extrinsics,
                        const OpenCvHints& hints);
/// In meters; it reads back to the bit, by extra nodes that OpenCV's programs do not look at.
void write_opencv(const std::filesystem::path& intrinsics, const std::filesystem::path& extrinsics,
                  const Calibration& calibration);

/// The rotation nearest to `m` if that is within 1e-3 of it, else `m` as it is; what is_rotation() already
/// stays untouched, so that it goes out as it came in.
Matrix3 exact_rotation(const Matrix3& m);

/// Throws FileError, beginning with `file`, if problem_with_camera() finds something, or the lens model
/// breaks down in more of the image than is usable. `name` is left or right.
void refuse_absurd(const CameraModel& camera, const std::string& name, const std::filesystem::path& file);

/// Whether nine numbers, row by row, are fx, 0, cx, 0, fy, cy, 0, 0, 1: a camera without skew. What to say if
/// not.
bool is_camera_matrix(const std::vector<double>& numbers);
inline constexpr const char* kCameraMatrix =
    "allowed is fx, 0, cx, 0, fy, cy, 0, 0, 1, a camera without skew";

/// The fourth number of a right camera's projection, −fx·baseline; of the two or three that read back as this
/// baseline the one with the fewest digits, which is what another program's file had.
double right_shift(const Calibration& calibration);

/// The calibration with its id; throws FileError beginning with `file` if problem_with() or
/// problem_with_view() finds something.
Calibration sound_or_refused(Calibration calibration, const std::filesystem::path& file);

}  // namespace stereod
