// SPDX-License-Identifier: BSD-3-Clause
// Damaged frames and impossible timestamps.
#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include "tests/support/camera_bench.h"

namespace stereod::v4l2 {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;

class V4l2Damage : public testing::Test {
 protected:
  V4l2Camera& open_left() {
    bench_.make();
    EXPECT_TRUE(bench_.frame(*bench_.left));
    return *bench_.left;
  }

  CameraBench bench_;
};

TEST_F(V4l2Damage, OnlyDamagedFrames_ReasonNamed) {
  V4l2Camera& camera = open_left();
  bench_.left_camera->on_frame = [](FakeFrame& frame) { frame.bytes.resize(100); };
  EXPECT_FALSE(bench_.frame(camera, 1500));
  EXPECT_EQ(camera.report().state, SourceState::kStalled);
  EXPECT_THAT(camera.report().reason, HasSubstr("only damaged frames for 1.0 s, the last one too short"));
  EXPECT_GT(camera.report().incomplete, 20);
  bench_.left_camera->on_frame = nullptr;
  EXPECT_TRUE(bench_.frame(camera, 2000));
}

TEST_F(V4l2Damage, DamagedFrames_CountedByReason) {
  V4l2Camera& camera = open_left();
  int n = 0;
  bench_.left_camera->on_frame = [&](FakeFrame& frame) {
    switch (n++ % 6) {
      case 0:
        frame.flags |= V4L2_BUF_FLAG_ERROR;
        break;
      case 1:
        frame.bytesused = 0;
        break;
      case 2:
        frame.bytesused = 64 * 48 * 2 - 1;
        break;
      case 3:
        frame.bytesused = 1u << 30;
        break;
      case 4:
        frame.timestamp_ns -= 5'000'000'000;
        break;
      default:
        break;
    }
  };
  for (int i = 0; i < 10; ++i) {
    const FrameLease lease = bench_.frame(camera, 1000);
    ASSERT_TRUE(lease);
    EXPECT_EQ((lease.frame().sequence - 1) % 6, 5u) << "only whole frames are shown";
  }
  EXPECT_GE(camera.report().incomplete, 36);
  EXPECT_GE(camera.report().bad_timestamps, 9);
}

TEST_F(V4l2Damage, TimestampsGoBack_AcceptedAfterFive) {
  V4l2Camera& camera = open_left();
  bench_.left_camera->on_frame = [](FakeFrame& frame) { frame.timestamp_ns -= 200 * kMs; };
  for (int i = 0; i < 10; ++i) bench_.frame(camera, 200);
  EXPECT_EQ(camera.report().bad_timestamps, 4);
  EXPECT_EQ(camera.state(), SourceState::kStreaming);
}

TEST_F(V4l2Damage, EndOfFrameTimestamps_MovedBack) {
  bench_.right_camera->timestamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
  bench_.left_camera->keeps_phase = bench_.right_camera->keeps_phase = true;
  bench_.make();
  const std::int64_t left = bench_.frame(*bench_.left).frame().captured_ns;
  const std::int64_t right = bench_.frame(*bench_.right).frame().captured_ns;
  const std::int64_t period = 33'333'333;
  const std::int64_t phase = ((right - left) % period + period) % period;
  EXPECT_TRUE(phase < 10'000 || phase > period - 10'000) << phase << ", one frame earlier is the same phase";
  EXPECT_LT(right, bench_.video.now_ns() - 33 * kMs);
}

TEST_F(V4l2Damage, UnknownClock_ArrivalTime) {
  bench_.left_camera->timestamp_flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  bench_.left_camera->on_frame = [](FakeFrame& frame) { frame.timestamp_ns = 42; };
  V4l2Camera& camera = open_left();
  const FrameLease lease = bench_.frame(camera);
  ASSERT_TRUE(lease);
  EXPECT_NEAR(static_cast<double>(lease.frame().captured_ns),
              static_cast<double>(bench_.video.now_ns() - 33'333'333), 1e6);
}

}  // namespace
}  // namespace stereod::v4l2
