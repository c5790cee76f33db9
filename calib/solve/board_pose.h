// SPDX-License-Identifier: BSD-3-Clause
// The pose of a board, and its refinement.
#pragma once

#include <functional>
#include <vector>

#include "core/geometry/camera_model.h"

namespace stereod::calib {

/// The pose of a board for a camera: the board's point X lies at rotation·X + translation_m.
struct BoardPose {
  Matrix3 rotation;
  Vector3 translation_m;
};

/// Returns the residuals of a pose; always the same number of them.
using PoseResiduals = std::function<std::vector<double>(const BoardPose&)>;

/// Returns the pose near @p initial with the least sum of squared residuals (Levenberg-Marquardt method).
/// @p distance_m scales the steps of numerical differentiation: the board's distance from the camera.
BoardPose refine_pose(const PoseResiduals& residuals_at, BoardPose initial, double distance_m);

}  // namespace stereod::calib
