// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/subset_solver.h"

#include <stdexcept>

#include "calib/base/errors.h"

namespace stereod::calib {

CameraSolution SubsetSolver::camera(const PairIndices& pairs, Side side) const {
  std::vector<Corners> views;
  for (const std::size_t i : pairs) {
    const BoardPair& corners = result_.pairs[i].corners;
    views.push_back(side == Side::kLeft ? corners.left : corners.right);
  }
  return solve_camera(image_, result_.board, views, result_.lens);
}

StereoSolution SubsetSolver::rig(const PairIndices& pairs, const CameraModel& left,
                                 const CameraModel& right) const {
  std::vector<BoardPair> boards;
  for (const std::size_t i : pairs) boards.push_back(result_.pairs[i].corners);
  return solve_stereo(result_.board, boards, left, right, result_.lens);
}

BoardPose SubsetSolver::pose(const StereoRigEstimate& cameras, std::size_t index) const {
  const BoardPair& corners = result_.pairs[index].corners;
  return fitted_pose(cameras, result_.board, corners, solve_pose(cameras.left, result_.board, corners.left));
}

Calibration rectified(const StereoRigEstimate& cameras) {
  try {
    return rectified_pair(cameras.left, cameras.right, cameras.pose);
  } catch (const std::invalid_argument& error) {
    throw CalibrationError(error.what());
  }
}

}  // namespace stereod::calib
