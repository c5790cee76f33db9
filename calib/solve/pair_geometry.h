// SPDX-License-Identifier: BSD-3-Clause
// Geometry of one board seen by two cameras.
#pragma once

#include "calib/board/board.h"
#include "calib/solve/board_pose.h"
#include "core/geometry/stereo_rectification.h"

namespace stereod::calib {

/// Two camera models and the pose of the right camera relative to the left one, before rectification.
struct StereoRigEstimate {
  CameraModel left, right;
  StereoPose pose;
};

/// Returns the RMS distance [px] between @p corners and the projections of a board at @p pose.
double board_error_px(const CameraModel& camera, const Board& board, const BoardPose& pose,
                      const Corners& corners);

/// Returns the pose for the right camera of a board that has the pose @p in_left for the left one.
BoardPose seen_from_right(const StereoPose& pose, const BoardPose& in_left);

/// Returns the pose of the right camera that follows from the two poses of one board.
StereoPose relative_pose(const BoardPose& in_left, const BoardPose& in_right);

/// Returns the board pose for the left camera that fits both images best, starting at @p initial.
BoardPose fitted_pose(const StereoRigEstimate& cameras, const Board& board, const BoardPair& pair,
                      const BoardPose& initial);

/// Returns the RMS distance [px] over the corners of both images for a board at @p in_left.
double pair_error_px(const StereoRigEstimate& cameras, const Board& board, const BoardPair& pair,
                     const BoardPose& in_left);

}  // namespace stereod::calib
