// SPDX-License-Identifier: BSD-3-Clause
// The life of one camera: frames, unplugs, silence, slow starts.
#include "daemon/capture/v4l2/v4l2_camera.h"

#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>

#include "tests/support/allocation_counter.h"
#include "tests/support/camera_bench.h"

namespace stereod::v4l2 {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;

class V4l2CameraTest : public testing::Test {
 protected:
  V4l2Camera& open_left() {
    bench_.make();
    EXPECT_TRUE(bench_.frame(*bench_.left));
    return *bench_.left;
  }
  int logged(const std::string& text) const {
    return static_cast<int>(std::count_if(bench_.log.begin(), bench_.log.end(), [&](const std::string& line) {
      return line.find(text) != std::string::npos;
    }));
  }

  CameraBench bench_;
};

TEST_F(V4l2CameraTest, Yuyv_LendsDriverMemory) {
  V4l2Camera& camera = open_left();
  EXPECT_EQ(camera.state(), SourceState::kStreaming);
  EXPECT_EQ(camera.frame_size(), (Size{64, 48}));
  const FrameLease lease = bench_.frame(camera);
  ASSERT_TRUE(lease);
  const LumaView& luma = lease.frame().luma;
  EXPECT_EQ(luma.size, (Size{64, 48}));
  EXPECT_EQ(luma.pixel_stride, 2) << "YUYV is read in place";
  EXPECT_EQ(luma.row_stride, 128);
  EXPECT_EQ(luma.data[0], lease.frame().sequence);
  const SourceReport report = camera.report();
  EXPECT_EQ(report.state, SourceState::kStreaming);
  EXPECT_EQ(report.reason, "");
  EXPECT_EQ(report.format, "YUYV 64×48 at 30 Hz");
  EXPECT_THAT(report.device, HasSubstr("/dev/video0"));
  EXPECT_THAT(report.device, HasSubstr("Fake Camera"));
}

TEST_F(V4l2CameraTest, ManyFrames_BuffersGivenBack) {
  V4l2Camera& camera = open_left();
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(bench_.frame(camera, 50)) << i;
}

TEST_F(V4l2CameraTest, FramesOnLoan_NotOverwritten) {
  V4l2Camera& camera = open_left();
  std::vector<FrameLease> held;
  for (int i = 0; i < 3; ++i) held.push_back(bench_.frame(camera));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(bench_.frame(camera, 100));
  for (const FrameLease& lease : held) EXPECT_EQ(lease.frame().luma.data[0], lease.frame().sequence);
}

TEST_F(V4l2CameraTest, LateConsumer_NewestFrame) {
  V4l2Camera& camera = open_left();
  const std::uint32_t before = bench_.frame(camera).frame().sequence;
  const std::unique_ptr<Waiter> sleep = bench_.video.make_waiter();
  sleep->wait(-1, std::chrono::milliseconds(120));
  const FrameLease late = camera.next(std::chrono::milliseconds(10));
  ASSERT_TRUE(late);
  EXPECT_EQ(late.frame().sequence, before + 3);  // frames come 33 ms apart
  EXPECT_EQ(camera.report().superseded, 2);
  EXPECT_EQ(camera.report().sequence_gaps, 0) << "frames that the daemon dropped had arrived";
}

TEST_F(V4l2CameraTest, SequenceGaps_Counted) {
  V4l2Camera& camera = open_left();
  bench_.left_camera->on_frame = [](FakeFrame& frame) { frame.sequence *= 4; };
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(bench_.frame(camera));
  const std::int64_t missed = camera.report().sequence_gaps;
  EXPECT_GE(missed, 4 * 3);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(bench_.frame(camera));
  EXPECT_EQ(camera.report().sequence_gaps, missed + 5 * 3);
  bench_.left_camera->on_frame = nullptr;  // goes back: the driver started to count again, nothing is lost
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(bench_.frame(camera));
  EXPECT_EQ(camera.report().sequence_gaps, missed + 5 * 3);
}

TEST_F(V4l2CameraTest, AbsentCamera_UsedOncePlugged) {
  bench_.left_camera->plugged = false;
  bench_.make();
  EXPECT_FALSE(bench_.frame(*bench_.left, 300'000)) << "five minutes";
  EXPECT_EQ(bench_.left->state(), SourceState::kAbsent);
  EXPECT_EQ(bench_.left->report().state, SourceState::kAbsent);
  EXPECT_EQ(bench_.left->report().reason, "no camera at /dev/v4l/by-path/port-1; plug it in there");
  EXPECT_EQ(bench_.log.size(), 1u) << "logged once";
  const std::int64_t plugged_ns = bench_.video.now_ns();
  bench_.video.plug(*bench_.left_camera, true);
  ASSERT_TRUE(bench_.frame(*bench_.left));
  EXPECT_LT(bench_.video.now_ns() - plugged_ns, 200 * kMs) << "noticed by the event, not by the next search";
}

TEST_F(V4l2CameraTest, AbsentCamera_NoBusyWait) {
  bench_.left_camera->plugged = false;
  bench_.make();
  const int before = bench_.video.waits();
  EXPECT_FALSE(bench_.frame(*bench_.left, 60'000));
  EXPECT_LT(bench_.video.waits() - before, 3000)
      << "waits in a minute, with a timeout of 100 ms in each call";
}

TEST_F(V4l2CameraTest, Replug_StreamsAgain) {
  V4l2Camera& camera = open_left();
  for (int round = 1; round <= 5; ++round) {
    bench_.video.plug(*bench_.left_camera, false);
    EXPECT_FALSE(bench_.frame(camera, 3000));
    EXPECT_EQ(camera.report().state, SourceState::kAbsent);
    EXPECT_THAT(camera.report().reason, HasSubstr("unplugged"));
    EXPECT_EQ(bench_.video.open_descriptors(), 0);
    EXPECT_EQ(bench_.video.mappings(), 0);
    bench_.left_camera->node = "/dev/video" + std::to_string(7 + round);  // the port counts, not the number
    const std::int64_t plugged_ns = bench_.video.now_ns();
    bench_.video.plug(*bench_.left_camera, true);
    ASSERT_TRUE(bench_.frame(camera));
    EXPECT_LT(bench_.video.now_ns() - plugged_ns, 2000 * kMs);
    EXPECT_EQ(camera.report().state, SourceState::kStreaming);
    EXPECT_EQ(camera.report().reconnects, round);
    EXPECT_THAT(camera.report().last_fault, HasSubstr("unplugged"));
    EXPECT_EQ(logged("unplugged"), round) << "once each time";
    EXPECT_EQ(logged("streaming again"), round);
  }
}

TEST_F(V4l2CameraTest, Unplug_OtherUndisturbed) {
  bench_.make();
  bench_.run(500);
  bench_.video.plug(*bench_.left_camera, false);
  const CameraBench::Frames frames = bench_.run(3000);
  EXPECT_EQ(frames.left, 0);
  EXPECT_GE(frames.right, 85);
  EXPECT_EQ(bench_.right_camera->starts, 1);
  bench_.video.plug(*bench_.left_camera, true);
  EXPECT_GE(bench_.run(3000).left, 80);
  EXPECT_EQ(bench_.right_camera->starts, 1);
}

TEST_F(V4l2CameraTest, FrameOnLoan_ClosingWaits) {
  V4l2Camera& camera = open_left();
  FrameLease held = bench_.frame(camera);
  bench_.video.plug(*bench_.left_camera, false);
  EXPECT_FALSE(bench_.frame(camera, 500));
  bench_.video.plug(*bench_.left_camera, true);
  EXPECT_FALSE(bench_.frame(camera, 2000));
  EXPECT_EQ(held.frame().luma.data[0], held.frame().sequence) << "still readable";
  EXPECT_EQ(bench_.video.open_descriptors(), 1);
  held.end();
  EXPECT_TRUE(bench_.frame(camera, 1000));
}

TEST_F(V4l2CameraTest, SilentCamera_StalledThenRecovers) {
  V4l2Camera& camera = open_left();
  bench_.left_camera->frozen = true;
  EXPECT_FALSE(bench_.frame(camera, 1500));
  EXPECT_EQ(camera.report().state, SourceState::kStalled);
  EXPECT_THAT(camera.report().reason, HasSubstr("/dev/video0: no frame for 1.0 s"));
  EXPECT_FALSE(bench_.frame(camera, 20'000));
  EXPECT_EQ(camera.report().state, SourceState::kStalled);
  EXPECT_EQ(logged("stalled"), 1) << "independent of how often it is set up again";
  EXPECT_GT(bench_.left_camera->starts, 3);
  const std::int64_t thawed_ns = bench_.video.now_ns();
  bench_.left_camera->frozen = false;
  ASSERT_TRUE(bench_.frame(camera));
  EXPECT_LT(bench_.video.now_ns() - thawed_ns, 2000 * kMs);
  EXPECT_EQ(camera.report().state, SourceState::kStreaming);
}

// At any delay after a failed start.
TEST_F(V4l2CameraTest, NeedsNewStart_RecoversWithin2s) {
  bench_.left_camera->thaws_at_start = true;
  bench_.left_camera->start_latency_ns = 400 * kMs;
  V4l2Camera& camera = open_left();
  for (int late_ms = 1; late_ms < 1500; late_ms += 100) {
    bench_.left_camera->frozen = true;
    EXPECT_FALSE(bench_.frame(camera, 5000));
    const int starts = bench_.left_camera->starts;
    while (bench_.left_camera->starts == starts) camera.next(std::chrono::milliseconds(1));
    EXPECT_FALSE(bench_.frame(camera, late_ms));
    bench_.left_camera->frozen = false;
    const std::int64_t possible_ns = bench_.video.now_ns();
    ASSERT_TRUE(bench_.frame(camera));
    EXPECT_LT(bench_.video.now_ns() - possible_ns, 2000 * kMs) << late_ms;
  }
}

TEST_F(V4l2CameraTest, NeverDelivered_RestartedEverySecond) {
  bench_.left_camera->frozen = true;
  bench_.make();
  EXPECT_FALSE(bench_.frame(*bench_.left, 60'000));
  // 60 s minus six starts with a timeout of 3 s.
  EXPECT_GE(bench_.left_camera->starts, 60 - 6 * 2 - 3);
}

TEST_F(V4l2CameraTest, NeverDeliveredSlow_GetsLongStarts) {
  bench_.left_camera->start_latency_ns = 2500 * kMs;
  bench_.left_camera->frozen = true;
  bench_.left_camera->thaws_at_start = true;
  bench_.make();
  EXPECT_FALSE(bench_.frame(*bench_.left, 10'000));
  bench_.left_camera->frozen = false;
  EXPECT_TRUE(bench_.frame(*bench_.left, 10'000));
}

TEST_F(V4l2CameraTest, SlowStart_WaitedFor) {
  bench_.left_camera->start_latency_ns = 2500 * kMs;
  bench_.make();
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(bench_.frame(*bench_.left, 4000)) << round;
    EXPECT_EQ(bench_.left_camera->starts, 2 * round + 1);
    bench_.left_camera->frozen = true;  // stalled, and started again
    EXPECT_FALSE(bench_.frame(*bench_.left, 1100));
    bench_.left_camera->frozen = false;
    ASSERT_TRUE(bench_.frame(*bench_.left, 4000)) << round;
    EXPECT_EQ(bench_.left_camera->starts, 2 * round + 2) << "its start time is known";
    bench_.video.plug(*bench_.left_camera, false);
    EXPECT_FALSE(bench_.frame(*bench_.left, 1500));
    bench_.video.plug(*bench_.left_camera, true);
  }
}

TEST_F(V4l2CameraTest, PermissionOrMemory_RemedyNamed) {
  bench_.left_camera->faults[kFakeOpen] = {EACCES, 1'000'000};
  bench_.right_camera->faults[VIDIOC_REQBUFS] = {ENOMEM, 1'000'000};
  bench_.make();
  bench_.run(1000);
  EXPECT_THAT(bench_.left->report().reason, HasSubstr("not permitted; add this user to the group"));
  EXPECT_THAT(bench_.right->report().reason, HasSubstr("no memory for buffers"));
}

TEST_F(V4l2CameraTest, Stop_ReleasesEverything) {
  V4l2Camera& camera = open_left();
  camera.stop();
  EXPECT_FALSE(camera.next(std::chrono::milliseconds(1000)));
  bench_.left.reset();
  EXPECT_EQ(bench_.video.open_descriptors(), 0);
  EXPECT_EQ(bench_.video.mappings(), 0);
}

TEST_F(V4l2CameraTest, SizeOrFormatMissing_OffersNamed) {
  bench_.config.v4l2.format = "gray";
  bench_.make();
  EXPECT_FALSE(bench_.frame(*bench_.left, 1000));
  EXPECT_EQ(bench_.left->report().reason,
            "/dev/video0 (Fake Camera) has no 64×48 as gray; at that size it offers yuyv");
  bench_.config.v4l2.format = "auto";
  bench_.config.v4l2.width = 1000;
  bench_.make();
  EXPECT_FALSE(bench_.frame(*bench_.left, 1000));
  EXPECT_EQ(bench_.left->report().reason,
            "/dev/video0 (Fake Camera) has no 1000×48; 'stereod --list-cameras' shows the sizes it has");
}

TEST_F(V4l2CameraTest, DriverChangesRequest_Refused) {
  bench_.left_camera->on_set_format = [](DeviceFormat& format) { format.size = {32, 24}; };
  bench_.make();
  EXPECT_FALSE(bench_.frame(*bench_.left, 1000));
  EXPECT_EQ(bench_.left->report().reason,
            "/dev/video0 was asked for YUYV 64×48 and gives YUYV 32×24; set cameras.v4l2 to what it gives");
  bench_.left_camera->on_set_format = [](DeviceFormat& format) { format.image_bytes = 100; };
  EXPECT_FALSE(bench_.frame(*bench_.left, 1000));
  EXPECT_EQ(bench_.left->report().reason,
            "/dev/video0: buffers of 100 bytes are too small for YUYV 64×48 at 30 Hz");
  bench_.left_camera->on_set_format = nullptr;
  EXPECT_TRUE(bench_.frame(*bench_.left, 1000));
}

TEST_F(V4l2CameraTest, PaddedRows_Read) {
  bench_.left_camera->on_set_format = [](DeviceFormat& format) {
    format.bytes_per_line = 160;
    format.image_bytes = 160 * 48;
  };
  bench_.left_camera->on_frame = [](FakeFrame& frame) { frame.bytes.resize(160 * 48); };
  V4l2Camera& camera = open_left();
  EXPECT_EQ(bench_.frame(camera).frame().luma.row_stride, 160);
}

TEST_F(V4l2CameraTest, Next_AllocatesNothing) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "allocations cannot be counted in this build";
  V4l2Camera& camera = open_left();
  // The fake itself allocates for its frames, so the frames are made beforehand, in the driver's queue.
  for (int i = 0; i < 20; ++i) {
    FrameLease held = bench_.frame(camera);
    bench_.video.make_waiter()->wait(-1, std::chrono::milliseconds(100));
    const AllocationCounter counter;
    const FrameLease lease = camera.next(std::chrono::milliseconds(0));
    EXPECT_EQ(counter.count(), 0u);
    EXPECT_TRUE(lease);
  }
}

}  // namespace
}  // namespace stereod::v4l2
