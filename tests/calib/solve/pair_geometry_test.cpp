// SPDX-License-Identifier: BSD-3-Clause
// Board poses and the consensus of pairs, on exact corners.
#include "calib/solve/pair_geometry.h"

#include <gtest/gtest.h>

#include "calib/solve/pair_check.h"
#include "calib/solve/pair_consensus.h"
#include "tests/support/board_scene.h"

namespace stereod::calib {
namespace {

// A third of the boards moved between the two images; the other pairs are exact.
TEST(PairConsensus, MovedBoards_LargeErrors) {
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({640, 480});
  std::vector<PosedPair> pairs;
  const auto poses = varied_poses(board, 12);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const BoardPose& seen_right = i % 3 == 1 ? poses[(i + 5) % poses.size()] : poses[i];
    PosedPair pair{{}, poses[i], seen_from_right(cameras.pose, seen_right)};
    pair.corners.left = projected_corners(cameras.left, board, pair.in_left);
    pair.corners.right = projected_corners(cameras.right, board, pair.in_right);
    pairs.push_back(pair);
  }
  const std::vector<double> errors = consensus_errors_px({cameras.left, cameras.right, {}}, board, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i % 3 == 1) {
      EXPECT_GT(errors[i], 5) << i;
    } else {
      EXPECT_LT(errors[i], 1e-6) << i;
    }
  }
}

TEST(PairGeometry, FittedPose_MatchesTruth) {
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({640, 480});
  const BoardPose truth = board_at(board, {0.05, -0.03, 0.6}, {0.4, -0.3, 0.2});
  BoardPair pair{projected_corners(cameras.left, board, truth),
                 projected_corners(cameras.right, board, seen_from_right(cameras.pose, truth))};
  BoardPose initial = truth;
  initial.translation_m = {0.1, 0.02, 0.5};
  initial.rotation = rotation_about({0.1, 0.1, 0}) * initial.rotation;
  const BoardPose found = fitted_pose(cameras, board, pair, initial);
  EXPECT_NEAR(pair_error_px(cameras, board, pair, found), 0, 1e-6);
  EXPECT_NEAR(found.translation_m.z, truth.translation_m.z, 1e-7);

  const Calibration c = rectified_pair(cameras.left, cameras.right, cameras.pose);
  const PairCheck exact = check_pair(c, board, pair, found);
  EXPECT_NEAR(exact.epipolar_error_px, 0, 1e-6);
  EXPECT_NEAR(exact.disparity_error_px, 0, 1e-5);
  EXPECT_NEAR(exact.scale_error, 0, 1e-8);
  Calibration longer = c;
  longer.baseline_m *= 1.02;
  EXPECT_NEAR(check_pair(longer, board, pair, found).scale_error, 0.02, 1e-6);
  for (Point2& p : pair.right) p.y += 0.4;
  EXPECT_NEAR(check_pair(c, board, pair, found).epipolar_error_px, 0.4, 0.05);
}

}  // namespace
}  // namespace stereod::calib
