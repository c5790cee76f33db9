// SPDX-License-Identifier: BSD-3-Clause
// Measures a calibration on one pair of board images.
#pragma once

#include "calib/board/board.h"
#include "calib/solve/board_pose.h"
#include "core/geometry/calibration.h"

namespace stereod::calib {

/// The errors of a calibration on one pair.
struct PairCheck {
  double epipolar_error_px = 0;  ///< mean over the corners of |row left − row right| in the rectified images
  double row_offset_px = 0;      ///< mean over the corners of row left − row right
  double disparity_error_px = 0;  ///< RMS difference from a board of the true size in the best pose
  double scale_error = 0;         ///< measured size of the board / its true size − 1
  double behind_share = 0;        ///< share of corners whose disparity places them behind the cameras, 0…1
};

/// Measures @p calibration on @p pair. @p in_left is the board's pose for the left camera.
/// All errors are infinite if more than 10 % of the corners have no rectified position.
PairCheck check_pair(const Calibration& calibration, const Board& board, const BoardPair& pair,
                     const BoardPose& in_left);

}  // namespace stereod::calib
