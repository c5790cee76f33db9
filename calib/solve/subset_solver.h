// SPDX-License-Identifier: BSD-3-Clause
// Solves for cameras from a subset of a session's pairs.
#pragma once

#include <cstddef>
#include <vector>

#include "calib/solve/camera_solver.h"
#include "calib/solve/solve.h"
#include "core/sync/pairing.h"

namespace stereod::calib {

/// Indices into SolveResult::pairs, ascending.
using PairIndices = std::vector<std::size_t>;

/// Applies the functions of camera_solver.h to some pairs of one SolveResult, with its board and lens model.
class SubsetSolver {
 public:
  /// @p result must outlive the object. @p image: the size of all images.
  SubsetSolver(const SolveResult& result, Size image) : result_(result), image_(image) {}

  Size image() const { return image_; }

  /// Solves for one camera alone.
  CameraSolution camera(const PairIndices& pairs, Side side) const;

  /// Solves for both cameras, starting at @p left and @p right.
  StereoSolution rig(const PairIndices& pairs, const CameraModel& left, const CameraModel& right) const;

  /// Returns the board's pose for the left camera in pair @p index, fitted to both images.
  BoardPose pose(const StereoRigEstimate& cameras, std::size_t index) const;

 private:
  const SolveResult& result_;
  Size image_;
};

/// Returns the rectified calibration of @p cameras, without quality.
/// @throws CalibrationError if left and right are swapped or not side by side.
Calibration rectified(const StereoRigEstimate& cameras);

}  // namespace stereod::calib
