// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes calibration files of other programs.
//
// Readers return a valid calibration with its id. A rotation matrix with so few digits that it is not orthonormal
// within 1e-6 is replaced by the nearest rotation; all other numbers are kept.
// All functions throw FileError with one sentence: file, place, value found, value allowed.
#pragma once

#include <filesystem>

#include "core/geometry/calibration.h"

namespace stereod::calib {

/// Reads ROS camera_info YAML files, as ROS' camera_calibration writes them.
Calibration read_ros(const std::filesystem::path& left, const std::filesystem::path& right);

/// Writes ROS camera_info YAML files. read_ros() reads them back bit for bit: values that ROS has no field for are in
/// an extra map `stereod`, which ROS ignores.
void write_ros(const std::filesystem::path& left, const std::filesystem::path& right,
               const Calibration& calibration);

/// Reads a Kalibr camchain; cam0 is the left camera, cam1 the right one. The file has no rectification, so it is
/// computed.
Calibration read_kalibr(const std::filesystem::path& camchain);

/// Values that OpenCV's files may lack.
struct OpenCvHints {
  Size image;            ///< 0×0: taken from the file (write_opencv() stores it)
  double unit_m = 1;     ///< length of 1 in the files [m]
  bool fisheye = false;  ///< D1 and D2 belong to the fisheye model
};

/// Reads OpenCV FileStorage (.yml, .xml or .json), as OpenCV's sample stereo_calib writes it: M1, D1, M2, D2; R, T,
/// and R1, R2, P1, P2 if present.
Calibration read_opencv(const std::filesystem::path& intrinsics, const std::filesystem::path& extrinsics,
                        const OpenCvHints& hints);

/// Writes OpenCV FileStorage, lengths in meters. read_opencv() reads it back bit for bit: extra nodes, which OpenCV's
/// programs ignore, hold the rest.
void write_opencv(const std::filesystem::path& intrinsics, const std::filesystem::path& extrinsics,
                  const Calibration& calibration);

}  // namespace stereod::calib
