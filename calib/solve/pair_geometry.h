// How well one pair of board images fits two cameras.
#pragma once

#include <vector>

#include "calib/board/board.h"
#include "core/geometry/stereo_rectification.h"

namespace stereod {

/// A board seen by both cameras; the same corner is at the same place of both lists.
struct BoardPair {
  Corners left, right;
};

/// The two cameras and how they stand to each other.
struct StereoRigEstimate {
  CameraModel left, right;
  StereoPose pose;
};

/// Where a board is: the point X of the board's plane is rotation·X + translation_m for a camera.
struct BoardPose {
  Matrix3 rotation;
  Vector3 translation_m;
};

/// How far, root mean square over the corners, in pixels, a board at `pose` is from where one camera saw it.
double board_error_px(const CameraModel& camera, const Board& board, const BoardPose& pose,
                      const Corners& corners);

/// The pose for the right camera of a board that is at `in_left` for the left one.
BoardPose seen_from_right(const StereoPose& pose, const BoardPose& in_left);

/// The pose of the right camera that these two poses of one board mean.
StereoPose relative_pose(const BoardPose& in_left, const BoardPose& in_right);

/// The board pose, for the left camera, that fits both images best, from a first guess (Levenberg and
/// Marquardt's method).
BoardPose fitted_pose(const StereoRigEstimate& cameras, const Board& board, const BoardPair& pair,
                      const BoardPose& guess);

/// Root mean square over the corners of both images of the error that remains at `in_left`, px.
double pair_error_px(const StereoRigEstimate& cameras, const Board& board, const BoardPair& pair,
                     const BoardPose& in_left);

/// What a pair that was not used for it shows about a calibration.
struct PairCheck {
  double epipolar_error_px = 0;   ///< mean of |row left − row right| of a corner in the rectified images
  double row_offset_px = 0;       ///< mean of row left − row right
  double disparity_error_px = 0;  ///< root mean square against a board of the true size in the best pose
  double scale_error = 0;         ///< measured size of the board / its true size − 1
  double behind = 0;              ///< share of the corners that would lie behind the cameras
};
PairCheck check_pair(const Calibration& calibration, const Board& board, const BoardPair& pair,
                     const BoardPose& in_left);

}  // namespace stereod
