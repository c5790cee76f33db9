// Two free-running cameras brought into phase.
#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>

#include "tests/support/camera_bench.h"

namespace stereod {
namespace {

using testing::HasSubstr;

class Phase : public testing::Test {
 protected:
  Phase() {
    bench_.config.v4l2.sync = SyncMode::kStart;
    bench_.left_camera->start_latency_ns = 200'000'000;
    bench_.right_camera->start_latency_ns = 216'000'000;  // 16 ms apart
  }
  CameraBench bench_;
};

TEST_F(Phase, ComesFromSixteenMillisecondsBelowThree) {
  bench_.make();
  bench_.run(8000);
  const PhaseSyncReport phase = bench_.pair->phase();
  EXPECT_EQ(phase.state, PhaseSyncState::kAligned);
  EXPECT_LT(std::abs(phase.skew_ms), 3);
  EXPECT_GE(phase.restarts, 1);
  EXPECT_EQ(bench_.left_camera->starts, 1) << "the left stream goes on";
  EXPECT_EQ(bench_.right_camera->starts, 1 + phase.restarts);
  const CameraBench::Frames frames = bench_.run(3000);
  EXPECT_GE(frames.right, 85) << "and then is left alone";
}

// Crystals 20 ppm apart: six milliseconds in five minutes.
TEST_F(Phase, AnHourOfDriftIsFollowed) {
  bench_.config.v4l2.sync = SyncMode::kAlways;
  bench_.right_camera->drift_ppb = 20'000;
  bench_.make();
  bench_.run(8000);
  ASSERT_EQ(bench_.pair->phase().state, PhaseSyncState::kAligned);
  const std::int64_t restarts_before = bench_.pair->phase().restarts;
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
  EXPECT_LT(apart, frames / 100) << "twice the target is left at once";
  const std::int64_t restarts = bench_.pair->phase().restarts - restarts_before;
  EXPECT_GE(restarts, 8);
  EXPECT_LE(restarts, 16);
  EXPECT_EQ(bench_.left_camera->starts, 1);
}

TEST_F(Phase, FramesOnLoanDoNotStandInItsWay) {
  bench_.make();
  FrameLease held = bench_.frame(*bench_.right);
  bench_.run(8000);
  EXPECT_EQ(bench_.pair->phase().state, PhaseSyncState::kAligned);
  EXPECT_EQ(held.frame().luma.data[0], held.frame().sequence);
  held.end();
  EXPECT_GE(bench_.run(3000).right, 85);
}

TEST_F(Phase, ARestartThatFailsIsAFaultLikeAnyOther) {
  bench_.make();
  bench_.right_camera->faults[VIDIOC_STREAMON] = {EIO, 1, 1};
  bench_.run(10'000);
  EXPECT_EQ(bench_.right->report().reconnects, 1);
  EXPECT_EQ(bench_.pair->phase().state, PhaseSyncState::kAligned);
}

TEST_F(Phase, ARestartThatFindsTheBusFullSaysSo) {
  bench_.config.v4l2.format = "yuyv";
  bench_.make();
  bench_.right_camera->faults[VIDIOC_STREAMON] = {ENOSPC, 1, 1};
  bench_.run(10'000);
  EXPECT_THAT(bench_.right->report().last_fault, HasSubstr("cannot carry YUYV 64×48 at 30/s beside"));
  EXPECT_EQ(bench_.pair->phase().state, PhaseSyncState::kAligned);
}

TEST_F(Phase, ACameraThatComesBackIsAlignedWithoutTouchingTheOther) {
  bench_.make();
  bench_.run(8000);
  bench_.video.plug(*bench_.left_camera, false);
  bench_.run(1000);
  const int right_starts = bench_.right_camera->starts;
  bench_.video.plug(*bench_.left_camera, true);
  bench_.run(8000);
  EXPECT_EQ(bench_.pair->phase().state, PhaseSyncState::kAligned);
  EXPECT_EQ(bench_.right_camera->starts, right_starts);
}

TEST_F(Phase, SensorsThatRunOnAreReportedAsTheyAre) {
  bench_.left_camera->keeps_phase = bench_.right_camera->keeps_phase = true;
  bench_.right_camera->phase_ns = 10'000'000;
  bench_.make();
  bench_.run(15'000);
  const PhaseSyncReport phase = bench_.pair->phase();
  EXPECT_EQ(phase.state, PhaseSyncState::kGivenUp);
  EXPECT_NEAR(phase.skew_ms, 10, 0.1);
  EXPECT_EQ(phase.restarts, 3);
  EXPECT_GE(bench_.run(3000).right, 85);
}

TEST_F(Phase, NeverLeavesThemAlone) {
  bench_.config.v4l2.sync = SyncMode::kNone;
  bench_.make();
  bench_.run(5000);
  EXPECT_EQ(bench_.pair->phase().state, PhaseSyncState::kOff);
  EXPECT_NE(bench_.pair->phase().skew_ms, 0);
  EXPECT_EQ(bench_.right_camera->starts, 1);
}

}  // namespace
}  // namespace stereod
