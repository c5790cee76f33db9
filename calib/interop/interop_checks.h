// SPDX-License-Identifier: BSD-3-Clause
// Checks and conversions shared by the file formats of interop.h.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/calibration.h"

namespace stereod::calib {

/// Returns the rotation nearest to @p m if @p m is within 1e-3 of one; otherwise returns @p m. A matrix for which
/// is_rotation() holds is returned unchanged, so that export writes the numbers that import read.
Matrix3 exact_rotation(const Matrix3& m);

/// @throws FileError, beginning with @p file, if problem_with_camera() finds a problem or the distortion folds over
/// in more of the image than is usable. @p name is "left" or "right".
void require_plausible(const CameraModel& camera, const std::string& name, const std::filesystem::path& file);

/// Returns whether nine numbers, row by row, are fx, 0, cx, 0, fy, cy, 0, 0, 1: a camera matrix without skew.
bool is_camera_matrix(const std::vector<double>& numbers);

/// The error message if not is_camera_matrix().
inline constexpr const char* kCameraMatrix =
    "allowed is fx, 0, cx, 0, fy, cy, 0, 0, 1 (a camera without skew)";

/// Returns the shortest decimal number that reads back to the same bits.
std::string shortest_decimal(double number);

/// Returns the fourth number of a right camera's projection matrix, −fx·baseline. Of the values that read back as
/// this baseline, returns the one with the fewest digits, which is the one an imported file had.
double right_shift(const Calibration& calibration);

/// Returns @p calibration with its id.
/// @throws FileError, beginning with @p file, if problem_with() or problem_with_view() finds a problem.
Calibration validated(Calibration calibration, const std::filesystem::path& file);

}  // namespace stereod::calib
