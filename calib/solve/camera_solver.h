// SPDX-License-Identifier: BSD-3-Clause
// Solves for camera parameters, with OpenCV.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "calib/board/board.h"
#include "calib/solve/pair_geometry.h"

namespace stereod::calib {

/// The distortion model to solve for. Coefficients are OpenCV's.
enum class LensChoice {
  kPinhole,    ///< 5 coefficients: radial k1 k2 k3, tangential p1 p2
  kRational,   ///< 8: adds k4 k5 k6, for wide lenses
  kThinPrism,  ///< 12: adds s1…s4
  kTilted,     ///< 14: adds the tilt of the sensor
  kFisheye,    ///< 4: equidistant
};
inline constexpr std::string_view kLensChoices = "pinhole, rational, thin-prism, tilted, fisheye";

/// Returns the model with this name, one of kLensChoices.
std::optional<LensChoice> parse_lens(std::string_view name);

struct CameraSolution {
  CameraModel camera;
  double rms_px = 0;  ///< reprojection error
};

/// Solves for one camera from several views of the board.
/// @throws CalibrationError if OpenCV finds no finite solution.
CameraSolution solve_camera(Size image, const Board& board, std::span<const Corners> views, LensChoice lens);

struct StereoSolution {
  StereoRigEstimate cameras;
  double rms_px = 0;  ///< reprojection error over both cameras
};

/// Solves for both cameras and their relative pose together, starting at @p left and @p right.
/// @throws CalibrationError if OpenCV finds no finite solution.
StereoSolution solve_stereo(const Board& board, std::span<const BoardPair> pairs, const CameraModel& left,
                            const CameraModel& right, LensChoice lens);

/// Solves for the pose of the board from its corners in one image.
/// @throws CalibrationError if OpenCV finds none.
BoardPose solve_pose(const CameraModel& camera, const Board& board, const Corners& corners);

}  // namespace stereod::calib
