// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/pair_consensus.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "calib/base/statistics.h"

namespace stereod::calib {

namespace {

// Returns the larger error of two transfers: from the left camera's pose to the right image, and back.
double transfer_error_px(const StereoRigEstimate& cameras, const StereoPose& pose, const Board& board,
                         const PosedPair& pair) {
  const double to_right =
      board_error_px(cameras.right, board, seen_from_right(pose, pair.in_left), pair.corners.right);
  const Matrix3 back = transposed(pose.rotation);
  const Vector3 shift = back * pose.translation_m;
  const StereoPose inverse{back, {-shift.x, -shift.y, -shift.z}};
  const double to_left =
      board_error_px(cameras.left, board, seen_from_right(inverse, pair.in_right), pair.corners.left);
  return std::max(to_right, to_left);
}

}  // namespace

std::vector<double> consensus_errors_px(const StereoRigEstimate& cameras, const Board& board,
                                        std::span<const PosedPair> pairs) {
  std::vector<double> best;
  double min_median = std::numeric_limits<double>::infinity();
  for (const PosedPair& candidate : pairs) {
    const StereoPose pose = relative_pose(candidate.in_left, candidate.in_right);
    std::vector<double> errors;
    for (const PosedPair& pair : pairs) errors.push_back(transfer_error_px(cameras, pose, board, pair));
    const double middle = median(errors);
    if (middle < min_median || best.empty()) {
      min_median = middle;
      best = std::move(errors);
    }
  }
  return best;
}

}  // namespace stereod::calib
