// SPDX-License-Identifier: BSD-3-Clause
// The rendered cameras: order, times, board, allocations.
#include "daemon/capture/synthetic/synthetic_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <thread>
#include <vector>

#include "core/rectify/rectify_map.h"
#include "daemon/capture/synthetic/synthetic_scene.h"
#include "tests/support/allocation_counter.h"

namespace stereod {
namespace {

using namespace std::chrono_literals;

bool equal(const GrayImage& a, const GrayImage& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.height(); ++y) {
    if (std::memcmp(a.row(y), b.row(y), static_cast<std::size_t>(a.width())) != 0) return false;
  }
  return true;
}

GrayImage copy_of(const LumaView& luma) {
  GrayImage image(luma.size);
  RectifyMap::identity({luma.size, luma.row_stride, luma.pixel_stride})
      .gray_rows(luma.data, {0, luma.size.height}, image.view());
  return image;
}

TEST(SyntheticSource, Loop_LendsFramesInOrder) {
  const SyntheticPair pair = make_synthetic_pair({.size = {96, 64}, .fps = 0, .frames = 3, .skew = 2ms});
  const SyntheticScene scene({96, 64}, 3);
  EXPECT_EQ(pair.calibration, scene.calibration());
  EXPECT_EQ(pair.left->frame_size(), (Size{96, 64}));
  EXPECT_EQ(pair.left->state(), SourceState::kWaiting);
  const std::uint8_t* first = nullptr;
  for (int n = 0; n < 7; ++n) {
    const FrameLease left = pair.left->next(20s), right = pair.right->next(20s);
    ASSERT_TRUE(left && right);
    EXPECT_EQ(left.frame().sequence, static_cast<std::uint32_t>(n));
    EXPECT_EQ(right.frame().sequence, static_cast<std::uint32_t>(n));
    EXPECT_EQ(right.frame().captured_ns - left.frame().captured_ns, 2'000'000);
    EXPECT_TRUE(equal(copy_of(left.frame().luma), scene.render_left(n)));
    EXPECT_TRUE(equal(copy_of(right.frame().luma), scene.render_right(n)));
    if (n == 0) first = left.frame().luma.data;
    EXPECT_EQ(left.frame().luma.data == first, n % 3 == 0);  // lent, not copied
  }
  EXPECT_EQ(pair.left->state(), SourceState::kStreaming);
}

// Returns where a point of the scene is in a camera's image.
Point2 seen_at(const CameraCalibration& camera, double from_left_m, const Vector3& in_rectified_left) {
  const Vector3 p{in_rectified_left.x - from_left_m, in_rectified_left.y, in_rectified_left.z};
  const Vector3 ray = transposed(camera.rotation) * p;
  return camera.camera.to_pixel(camera.camera.distort({ray.x / ray.z, ray.y / ray.z}));
}

TEST(SyntheticSource, Board_FullyVisibleInBothCameras) {
  for (const Size size : {Size{320, 240}, Size{640, 360}, Size{240, 240}}) {
    const SyntheticPair pair = make_synthetic_pair({.size = size, .fps = 0, .board = true});
    const double focal = pair.calibration.left.projection.fx;
    const std::vector<BoardPlace> places = varied_places(kPracticeBoard, 0.4 * size.width / focal,
                                                         0.47 * size.height / focal, 0.06, kBoardPlaces);
    int same = 0, frames = 0, held = 0;
    GrayImage last(size);
    // Out of sight for four frames; then for each place two frames on the way and four at rest.
    for (int n = 0; n < 4 + 6 * kBoardPlaces; ++n, ++frames) {
      const FrameLease left = pair.left->next(20s), right = pair.right->next(20s);
      ASSERT_TRUE(left && right);
      GrayImage now = copy_of(left.frame().luma);
      same += equal(now, last) ? 1 : 0;
      last = std::move(now);
      if (n < 4 || (n - 4) % 6 != 5) continue;
      const BoardPlace& place = places[static_cast<std::size_t>(held++)];
      for (int row = -1; row < kPracticeBoard.rows; ++row) {
        for (int column = -1; column < kPracticeBoard.columns; ++column) {
          const Vector3 on_board = place.rotation * Vector3{(column + 0.5) * kPracticeBoard.square_m,
                                                            (row + 0.5) * kPracticeBoard.square_m, 0};
          const Vector3 at{on_board.x + place.origin_m.x, on_board.y + place.origin_m.y,
                           on_board.z + place.origin_m.z};
          for (const bool is_left : {true, false}) {
            const Point2 p = seen_at(is_left ? pair.calibration.left : pair.calibration.right,
                                     is_left ? 0 : pair.calibration.baseline_m, at);
            ASSERT_TRUE(p.x >= 0 && p.y >= 0 && p.x <= size.width - 1 && p.y <= size.height - 1)
                << size.width << " place " << held << ' ' << column << ' ' << row
                << (is_left ? " left" : " right");
            const LumaView& luma = (is_left ? left : right).frame().luma;
            const int gray = luma.data[std::lround(p.y) * luma.row_stride + std::lround(p.x)];
            EXPECT_EQ(gray < 110, (row + column) % 2 == 0) << gray;
          }
        }
      }
    }
    EXPECT_EQ(held, kBoardPlaces);
    EXPECT_EQ(same, frames - 1 - 2 * kBoardPlaces);  // it rests, with two moves on each way
  }
}

TEST(SyntheticSource, BoardAtHighRate_StaysTwoSeconds) {
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 1000, .board = true});
  const FrameLease first = pair.left->next(20s);
  const std::uint8_t* const away = first.frame().luma.data;
  std::uint32_t frame = 0;
  while (frame < 1900) {
    const FrameLease lease = pair.left->next(20s);
    ASSERT_TRUE(lease);
    frame = lease.frame().sequence;
    if (frame <= 2000) {
      EXPECT_EQ(lease.frame().luma.data, away) << frame;
    }
  }
}

TEST(SyntheticSource, RateZero_WaitsForLease) {
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 0, .frames = 2});
  FrameLease left = pair.left->next(20s);
  const FrameLease right = pair.right->next(20s);
  ASSERT_TRUE(left && right);
  EXPECT_FALSE(pair.left->next(0ms));
  left.end();
  EXPECT_TRUE(pair.left->next(20s));
}

TEST(SyntheticSource, PacedWithSkew_NumbersAndTimesAgree) {
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 500, .frames = 2, .skew = -300us});
  const FrameLease first = pair.left->next(20s);
  ASSERT_TRUE(first);
  for (int i = 0; i < 10; ++i) {
    const FrameLease right = pair.right->next(20s);
    ASSERT_TRUE(right);
    const std::int64_t frames = std::int64_t{right.frame().sequence} - std::int64_t{first.frame().sequence};
    EXPECT_EQ(right.frame().captured_ns - first.frame().captured_ns, frames * 2'000'000 - 300'000);
  }
}

TEST(SyntheticSource, Stop_EndsWait) {
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 0.001, .frames = 1});
  EXPECT_TRUE(pair.left->next(24h));  // the first one is due at once, the second in a quarter of an hour
  std::jthread stopper([&] {
    std::this_thread::sleep_for(5ms);
    pair.left->stop();
  });
  EXPECT_FALSE(pair.left->next(24h));
  EXPECT_FALSE(pair.left->next(24h));
}

TEST(SyntheticSource, Next_AllocatesNothing) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "this build does not count allocations";
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 0, .frames = 2});
  const AllocationCounter allocations;
  for (int n = 0; n < 20; ++n) {
    const FrameLease left = pair.left->next(20s), right = pair.right->next(20s);
  }
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace stereod
