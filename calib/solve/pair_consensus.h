// SPDX-License-Identifier: BSD-3-Clause
// Finds the relative camera pose that most pairs support.
#pragma once

#include <span>
#include <vector>

#include "calib/solve/pair_geometry.h"

namespace stereod::calib {

/// One pair and the board's pose for each camera alone.
struct PosedPair {
  BoardPair corners;
  BoardPose in_left, in_right;
};

/// Returns the error [px] of each pair under the relative pose that most pairs support: of the relative poses of
/// the single pairs, the one with the least median error (least median of squares, Rousseeuw 1984). A pair whose
/// board moved between the two images has a large error, even if almost half of the pairs are such outliers.
/// Ignores `cameras.pose`.
std::vector<double> consensus_errors_px(const StereoRigEstimate& cameras, const Board& board,
                                        std::span<const PosedPair> pairs);

}  // namespace stereod::calib
