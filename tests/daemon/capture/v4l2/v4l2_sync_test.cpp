// SPDX-License-Identifier: BSD-3-Clause
// Synchronization of two free-running cameras.
#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>

#include "tests/support/camera_bench.h"

namespace stereod::v4l2 {
namespace {

using testing::HasSubstr;

class V4l2Sync : public testing::Test {
 protected:
  V4l2Sync() {
    bench_.config.v4l2.sync = SyncMode::kStart;
    bench_.left_camera->start_latency_ns = 200'000'000;
    bench_.right_camera->start_latency_ns = 216'000'000;  // 16 ms apart
  }
  CameraBench bench_;
};

TEST_F(V4l2Sync, Skew16ms_Below3) {
  bench_.make();
  bench_.run(8000);
  const PhaseSyncReport phase = bench_.pair->sync_report();
  EXPECT_EQ(phase.state, PhaseSyncState::kAligned);
  EXPECT_LT(std::abs(phase.skew_ms), 3);
  EXPECT_GE(phase.restarts, 1);
  EXPECT_EQ(bench_.left_camera->starts, 1) << "the left stream continues";
  EXPECT_EQ(bench_.right_camera->starts, 1 + phase.restarts);
  const CameraBench::Frames frames = bench_.run(3000);
  EXPECT_GE(frames.right, 85) << "no further restarts";
}

// Crystals 20 ppm apart: six milliseconds in five minutes.
TEST_F(V4l2Sync, HourOfDrift_Followed) {
  bench_.config.v4l2.sync = SyncMode::kAlways;
  bench_.right_camera->drift_ppb = 20'000;
  bench_.make();
  bench_.run(8000);
  ASSERT_EQ(bench_.pair->sync_report().state, PhaseSyncState::kAligned);
  const std::int64_t restarts_before = bench_.pair->sync_report().restarts;
  const std::int64_t period_ns = bench_.left_camera->period_ns;
  const std::int64_t end_ns = bench_.video.now_ns() + 3'600'000'000'000;
  std::int64_t left_ns = 0;
  int frames = 0, apart = 0;
  while (bench_.video.now_ns() < end_ns) {
    if (const FrameLease left = bench_.left->next(std::chrono::milliseconds(50)))
      left_ns = left.frame().captured_ns;
    if (const FrameLease right = bench_.right->next(std::chrono::milliseconds(50))) {
      const std::int64_t skew_ns = std::llabs(right.frame().captured_ns - left_ns) % period_ns;
      if (std::min(skew_ns, period_ns - skew_ns) > 6'100'000) ++apart;
      ++frames;
    }
  }
  EXPECT_GT(frames, 107'000) << "of 108,000";
  EXPECT_LT(apart, frames / 100) << "skew above twice the target is corrected at once";
  const std::int64_t restarts = bench_.pair->sync_report().restarts - restarts_before;
  EXPECT_GE(restarts, 8);
  EXPECT_LE(restarts, 16);
  EXPECT_EQ(bench_.left_camera->starts, 1);
}

TEST_F(V4l2Sync, FrameOnLoan_StillAligned) {
  bench_.make();
  FrameLease held = bench_.frame(*bench_.right);
  bench_.run(8000);
  EXPECT_EQ(bench_.pair->sync_report().state, PhaseSyncState::kAligned);
  EXPECT_EQ(held.frame().luma.data[0], held.frame().sequence);
  held.end();
  EXPECT_GE(bench_.run(3000).right, 85);
}

TEST_F(V4l2Sync, RestartFails_Recovered) {
  bench_.make();
  bench_.right_camera->faults[VIDIOC_STREAMON] = {EIO, 1, 1};
  bench_.run(10'000);
  EXPECT_EQ(bench_.right->report().reconnects, 1);
  EXPECT_EQ(bench_.pair->sync_report().state, PhaseSyncState::kAligned);
}

TEST_F(V4l2Sync, RestartWithFullBus_ReasonNamed) {
  bench_.config.v4l2.format = "yuyv";
  bench_.make();
  bench_.right_camera->faults[VIDIOC_STREAMON] = {ENOSPC, 1, 1};
  bench_.run(10'000);
  EXPECT_THAT(bench_.right->report().last_fault, HasSubstr("cannot carry YUYV 64×48 at 30 Hz beside"));
  EXPECT_EQ(bench_.pair->sync_report().state, PhaseSyncState::kAligned);
}

TEST_F(V4l2Sync, Replug_OtherUndisturbed) {
  bench_.make();
  bench_.run(8000);
  bench_.video.plug(*bench_.left_camera, false);
  bench_.run(1000);
  const int right_starts = bench_.right_camera->starts;
  bench_.video.plug(*bench_.left_camera, true);
  bench_.run(8000);
  EXPECT_EQ(bench_.pair->sync_report().state, PhaseSyncState::kAligned);
  EXPECT_EQ(bench_.right_camera->starts, right_starts);
}

TEST_F(V4l2Sync, SensorsKeepPhase_GivenUp) {
  bench_.left_camera->keeps_phase = bench_.right_camera->keeps_phase = true;
  bench_.right_camera->phase_ns = 10'000'000;
  bench_.make();
  bench_.run(15'000);
  const PhaseSyncReport phase = bench_.pair->sync_report();
  EXPECT_EQ(phase.state, PhaseSyncState::kGivenUp);
  EXPECT_NEAR(phase.skew_ms, 10, 0.1);
  EXPECT_EQ(phase.restarts, 3);
  EXPECT_GE(bench_.run(3000).right, 85);
}

TEST_F(V4l2Sync, ModeNone_NoRestart) {
  bench_.config.v4l2.sync = SyncMode::kNone;
  bench_.make();
  bench_.run(5000);
  EXPECT_EQ(bench_.pair->sync_report().state, PhaseSyncState::kNone);
  EXPECT_NE(bench_.pair->sync_report().skew_ms, 0);
  EXPECT_EQ(bench_.right_camera->starts, 1);
}

}  // namespace
}  // namespace stereod::v4l2
