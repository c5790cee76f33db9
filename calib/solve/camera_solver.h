// The numerical part of a calibration, by OpenCV.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "calib/board/board.h"
#include "calib/solve/pair_geometry.h"

namespace stereod {

/// What a lens is described with.
enum class LensChoice {
  kPinhole,    ///< 5 coefficients: radial k1 k2 k3, tangential p1 p2
  kRational,   ///< 8: with a denominator, for wide lenses
  kThinPrism,  ///< 12: and a thin prism
  kTilted,     ///< 14: and a tilted sensor
  kFisheye,    ///< 4: equidistant
};
inline constexpr std::string_view kLensChoices = "pinhole, rational, thin-prism, tilted, fisheye";
std::optional<LensChoice> parse_lens(std::string_view name);

struct CameraSolution {
  CameraModel camera;
  double rms_px = 0;
};

/// One camera from several images of a board. Throws CalibrationError if there is no solution.
CameraSolution solve_camera(Size image, const Board& board, std::span<const Corners> views, LensChoice lens);

struct StereoSolution {
  StereoRigEstimate cameras;
  double rms_px = 0;
};

/// Both cameras and how they stand, from first guesses of each. Throws CalibrationError.
StereoSolution solve_stereo(const Board& board, std::span<const BoardPair> pairs, const CameraModel& left,
                            const CameraModel& right, LensChoice lens);

/// Where a known camera sees the board. Throws CalibrationError if nowhere.
BoardPose solve_pose(const CameraModel& camera, const Board& board, const Corners& corners);

}  // namespace stereod
