// SPDX-License-Identifier: BSD-3-Clause
#include "calib/live/capture_guide.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/live/live_state.h"

namespace stereod::calib {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const Board kBoard{9, 6, 0.025};
constexpr Size kImage{640, 480};

// Returns a board with its center at (x, y) and this width [px]. `lean` makes its left side taller by this share.
Corners board_seen(double x, double y, double width, double lean = 0, double lean_down = 0) {
  Corners corners;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 9; ++column) {
      const double u = column / 8.0 - 0.5, v = row / 5.0 - 0.5;
      corners.push_back({x + width * u * (1 - lean_down * v), y + width * 5 / 8 * v * (1 - lean * u)});
    }
  }
  return corners;
}

// Shows a board for `frames` frames. Returns whether it was taken.
bool held(CaptureGuide& guide, const Corners& corners, int frames = 4) {
  bool taken = false;
  for (int i = 0; i < frames; ++i) taken = guide.observe(corners, corners).take || taken;
  return taken;
}

TEST(BoardView, KnownBoard_PlaceSizeLean) {
  const BoardView view = board_view(kBoard, board_seen(319.5, 119.5, 320, 0.2, -0.1), kImage);
  EXPECT_NEAR(view.x, 0.5, 0.01);
  EXPECT_NEAR(view.y, 0.25, 0.01);
  EXPECT_NEAR(view.size, std::sqrt(320.0 * 200 / (640 * 480)), 0.01);
  EXPECT_NEAR(view.lean_x, 0.2, 0.02);
  EXPECT_NEAR(view.lean_y, -0.1, 0.02);
  Corners turned = board_seen(319.5, 119.5, 320, 0.2, -0.1);
  std::reverse(turned.begin(), turned.end());  // half a turn does not change the view
  EXPECT_NEAR(board_view(kBoard, turned, kImage).lean_x, view.lean_x, 1e-12);
}

TEST(CaptureGuide, BoardUnseen_NamesCamera) {
  CaptureGuide guide(kBoard, kImage, 15);
  const Corners seen = board_seen(320, 240, 200);
  EXPECT_THAT(guide.observe({}, {}).words, HasSubstr("both cameras"));
  EXPECT_THAT(guide.observe(seen, {}).words, StartsWith("the right camera does not see the whole board"));
  EXPECT_THAT(guide.observe({}, seen).words, StartsWith("the left camera does not see the whole board"));
  EXPECT_FALSE(guide.observe({}, seen).left_seen);
  EXPECT_TRUE(guide.observe({}, seen).right_seen);
}

TEST(CaptureGuide, Take_OnlyStillAndNew) {
  CaptureGuide guide(kBoard, kImage, 15);
  for (int i = 0; i < 10; ++i) {  // moves 3 px from frame to frame
    const CaptureGuide::Instruction instruction =
        guide.observe(board_seen(300 + 3 * i, 240, 200), board_seen(280 + 3 * i, 240, 200));
    EXPECT_FALSE(instruction.take);
    EXPECT_EQ(instruction.words, "hold still");
  }
  EXPECT_TRUE(held(guide, board_seen(320, 240, 200)));
  EXPECT_EQ(guide.taken(), 1);
  EXPECT_FALSE(held(guide, board_seen(320, 240, 200), 20));  // not new
  EXPECT_FALSE(held(guide, board_seen(330, 240, 205), 20));
  EXPECT_TRUE(held(guide, board_seen(420, 240, 200)));
  EXPECT_TRUE(held(guide, board_seen(420, 240, 200, 0.2)));
  EXPECT_EQ(guide.taken(), 3);
  // Still in one camera only is not still.
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(guide.observe(board_seen(320, 100, 200), board_seen(250 + 3 * i, 100, 200)).take);
  }
}

TEST(CaptureGuide, MissingView_Requested) {
  CaptureGuide guide(kBoard, kImage, 15);
  const auto instruction = [&](const Corners& corners) {
    held(guide, corners);
    return guide.observe(corners, corners).words;
  };
  EXPECT_EQ(instruction(board_seen(320, 240, 200)), "come closer");
  EXPECT_THAT(instruction(board_seen(320, 240, 400)), HasSubstr("its left side towards"));
  EXPECT_THAT(instruction(board_seen(320, 240, 300, 0.3)), HasSubstr("its right side towards"));
  EXPECT_THAT(instruction(board_seen(320, 240, 300, -0.3)), HasSubstr("its upper side towards"));
  EXPECT_THAT(instruction(board_seen(320, 240, 300, 0, 0.3)), HasSubstr("its lower side towards"));
  EXPECT_THAT(instruction(board_seen(320, 240, 300, 0, -0.3)), StartsWith("move the board to the "));
  // A satisfied request is not repeated.
  EXPECT_EQ(guide.left_coverage().empty_parts().front(), "the upper left");
  EXPECT_THAT(instruction(board_seen(110, 80, 160)), testing::Not(HasSubstr("the upper left")));
}

TEST(CaptureGuide, Complete_NeedsPairsAndCoverage) {
  CaptureGuide guide(kBoard, kImage, 9);
  for (int i = 0; i < 9; ++i) {
    EXPECT_TRUE(held(guide, board_seen(120 + 200 * (i % 3), 90 + 150 * (i / 3), 190)));
    EXPECT_EQ(guide.observe({}, {}).complete, false);  // reported only with the board in view
  }
  EXPECT_TRUE(guide.observe(board_seen(120, 90, 190), board_seen(120, 90, 190)).complete);

  CaptureGuide corner(kBoard, kImage, 5);  // the board stays in the middle
  int taken = 0;
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(corner.observe(board_seen(320, 240, 100), board_seen(320, 240, 100)).complete);
    taken += held(corner, board_seen(320, 240, 100, 0.15 * i)) ? 1 : 0;
  }
  EXPECT_EQ(taken, 10);
  EXPECT_TRUE(corner.observe(board_seen(320, 240, 100), board_seen(320, 240, 100)).complete);
}

TEST(LiveState, Snapshot_LineAndJson) {
  CaptureGuide guide(kBoard, kImage, 15);
  const Corners seen = board_seen(320, 240, 200);
  held(guide, seen);
  const CaptureGuide::Instruction instruction = guide.observe(seen, {});
  const LiveSnapshot snapshot = snapshot_of(guide, instruction, seen, {}, kImage);
  const std::string line = status_line(snapshot);
  EXPECT_THAT(line, StartsWith("[#..............] 1/15 pairs | board: left yes right no  | coverage "));
  EXPECT_THAT(line, HasSubstr(instruction.words));
  const std::string json = json_of(snapshot);
  EXPECT_THAT(json, HasSubstr("\"taken\":1,\"wanted\":15"));
  EXPECT_THAT(json, HasSubstr("\"right\":{\"corners\":[],"));
  EXPECT_EQ(std::count(json.begin(), json.end(), '{'), std::count(json.begin(), json.end(), '}'));
}

}  // namespace
}  // namespace stereod::calib
