// SPDX-License-Identifier: BSD-3-Clause
#include "calib/board/board.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "calib/base/errors.h"
#include "calib/board/corner_order.h"
#include "tests/support/board_scene.h"

namespace stereod::calib {
namespace {

TEST(Board, Parse_InnerCorners) {
  EXPECT_EQ(parse_board("9x6"), (Board{9, 6, 0}));
  EXPECT_EQ(parse_board("11×8"), (Board{11, 8, 0}));
  EXPECT_EQ(parse_board("3X50"), (Board{3, 50, 0}));
  for (const char* text : {"", "9", "9x", "x6", "9x6x2", "2x6", "9x51", "9 x 6", "nine", "-9x6"}) {
    EXPECT_THROW(parse_board(text), UsageError) << text;
  }
}

TEST(Board, ParseLength_Units) {
  EXPECT_EQ(parse_length("25mm", "--square"), 0.025);
  EXPECT_EQ(parse_length("2.5cm", "--square"), 0.025);
  EXPECT_EQ(parse_length("0.025m", "--square"), 0.025);
  EXPECT_EQ(parse_length("1 in", "--square"), 0.0254);
  EXPECT_EQ(parse_length("24.23mm", "--square"), 0.02423);
  for (const char* text :
       {"", "25", "mm", "25 km", "-25mm", "0mm", "0.1mm", "11m", "nanmm", "infm", "25mmm"}) {
    EXPECT_THROW(parse_length(text, "--square"), UsageError) << text;
  }
}

TEST(Board, Ambiguous_EvenOrOddCounts) {
  EXPECT_FALSE((Board{9, 6, 0}.ambiguous()));
  EXPECT_TRUE((Board{8, 6, 0}.ambiguous()));
  EXPECT_TRUE((Board{9, 7, 0}.ambiguous()));
}

bool equal(const Corners& a, const Corners& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](Point2 p, Point2 q) { return p.x == q.x && p.y == q.y; });
}

TEST(CornerOrder, AnyListing_SameOrder) {
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({320, 240});
  const BoardScene scene(cameras, board);
  for (const double roll : {0.0, 1.5, 3.0}) {
    const BoardPose pose = board_at(board, {0, 0, 0.5}, {0.1, 0, roll});
    const ImagePair pair = scene.render(pose, 1);
    const Corners truth = projected_corners(cameras.left, board, pose);
    Corners mirrored = truth;
    for (int row = 0; row < 6; ++row)
      std::reverse(mirrored.begin() + row * 9, mirrored.begin() + row * 9 + 9);
    for (const Corners& listed : {truth, half_turned(truth), mirrored, half_turned(mirrored)}) {
      EXPECT_TRUE(equal(in_board_order(pair.left.view(), board, listed), truth));
    }
  }
}

TEST(CornerOrder, AmbiguousBoard_TurnedLikeReference) {
  const CameraModel camera = known_cameras({320, 240}).left;
  const Board even{8, 6, 0.025}, square{7, 7, 0.025};
  for (const Board& board : {even, square}) {
    const Corners left = projected_corners(camera, board, board_at(board, {0, 0, 0.5}, {0, 0, 0.1}));
    const Corners right = projected_corners(camera, board, board_at(board, {0, 0, 0.5}, {0, 0, 0.15}));
    EXPECT_TRUE(equal(*turned_like(left, board, right), right));
    EXPECT_TRUE(equal(*turned_like(left, board, half_turned(right)), right));
  }
  const Corners left = projected_corners(camera, even, board_at(even, {0, 0, 0.5}, {0, 0, 0}));
  const Corners aside = projected_corners(camera, even, board_at(even, {0, 0, 0.5}, {0, 0, 1.5}));
  EXPECT_FALSE(turned_like(left, even, aside).has_value());
  const Board told{9, 6, 0.025};
  const Corners any = projected_corners(camera, told, board_at(told, {0, 0, 0.5}, {0, 0, 3}));
  EXPECT_TRUE(equal(*turned_like(left, told, any), any));
}

}  // namespace
}  // namespace stereod::calib
