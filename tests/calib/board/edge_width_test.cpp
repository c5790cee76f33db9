// SPDX-License-Identifier: BSD-3-Clause
#include "calib/board/edge_width.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/board_scene.h"

namespace stereod::calib {
namespace {

TEST(EdgeWidth, Blur_Widens) {
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({640, 480});
  const BoardPose pose = board_at(board, {0, 0, 0.4}, {0.1, 0.1, 0.3});
  const ImagePair pair = BoardScene(cameras, board).render(pose, 1);
  const Corners corners = projected_corners(cameras.left, board, pose);
  const double sharp = edge_width_px(pair.left.view(), board, corners);
  EXPECT_NEAR(sharp, 1.8, 0.4);  // a ramp of 2 px, without 10 % at each end, and interpolation
  for (const bool across : {true, false}) {
    GrayImage blurred = copy_of(pair.left);
    for (int y = 4; y + 4 < blurred.height(); ++y) {
      for (int x = 4; x + 4 < blurred.width(); ++x) {
        int sum = 0;
        for (int d = -4; d <= 4; ++d) sum += across ? pair.left.at(x + d, y) : pair.left.at(x, y + d);
        blurred.at(x, y) = static_cast<std::uint8_t>(sum / 9);
      }
    }
    EXPECT_GT(edge_width_px(blurred.view(), board, corners), 6) << across;
  }
  EXPECT_GT(edge_width_px(GrayImage(640, 480).view(), board, corners), 20);  // no edges
}

TEST(EdgeWidth, BlurLimit_ScalesWithSize) {
  EXPECT_NEAR(blur_limit_px({320, 240}), 3.7, 0.05);
  EXPECT_NEAR(blur_limit_px({640, 480}), 6.0, 0.05);
  EXPECT_NEAR(blur_limit_px({1280, 720}), 11.2, 0.05);
  EXPECT_NEAR(blur_limit_px({1920, 1080}), 16.5, 0.05);
  EXPECT_EQ(blur_limit_px({480, 640}), blur_limit_px({640, 480}));
  EXPECT_GT(blur_limit_px({64, 48}), 2.5);  // a sharp image passes at any size

  // One lens, defocused by one angle, at different resolutions: refused at every resolution or at none.
  const Board board{9, 6, 0.025};
  const BoardPose pose = board_at(board, {0, 0, 0.4}, {0.1, 0.1, 0.3});
  for (const int width : {320, 1280}) {
    const StereoRigEstimate cameras = known_cameras({width, width * 3 / 4});
    const ImagePair pair = BoardScene(cameras, board).render(pose, 1);
    const Corners corners = projected_corners(cameras.left, board, pose);
    for (const double angle : {0.004, 0.016}) {  // half the width of the blur, as a share of the image width
      const int reach = static_cast<int>(std::lround(angle * width / 2));
      GrayImage blurred = copy_of(pair.left);
      for (int y = 0; y < blurred.height(); ++y) {
        for (int x = reach; x + reach < width; ++x) {
          int sum = 0;
          for (int d = -reach; d <= reach; ++d) sum += pair.left.at(x + d, y);
          blurred.at(x, y) = static_cast<std::uint8_t>(sum / (2 * reach + 1));
        }
      }
      const bool refused = edge_width_px(blurred.view(), board, corners) > blur_limit_px(blurred.size());
      EXPECT_EQ(refused, angle > 0.01) << width << ' ' << angle;
    }
  }
}

}  // namespace
}  // namespace stereod::calib
