// SPDX-License-Identifier: BSD-3-Clause
// Two cameras on a bus that cannot carry both streams.
#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>

#include "tests/support/camera_bench.h"
#include "tests/support/camera_jpeg.h"

namespace stereod::v4l2 {
namespace {

using testing::HasSubstr;

constexpr Size kSize{64, 48};
constexpr double kYuyvTraffic = 64 * 48 * 2 * 30.0;

class V4l2Bandwidth : public testing::Test {
 protected:
  V4l2Bandwidth() {
    const std::vector<std::uint8_t> jpeg = camera_jpeg(kSize, 99);
    for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
      camera->modes = {{make_fourcc('Y', 'U', 'Y', 'V'), kSize, {30, 15}},
                       {make_fourcc('M', 'J', 'P', 'G'), kSize, {30, 15, 7.5}}};
    }
  }
  void send_jpegs() {
    const std::vector<std::uint8_t> jpeg = camera_jpeg(kSize, 99);
    for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera})
      camera->on_frame = [jpeg](FakeFrame& frame) {
        // Large enough for both formats, with a JPEG at the front.
        std::copy(jpeg.begin(), jpeg.end(), frame.bytes.begin());
      };
  }
  CameraBench bench_;
};

TEST_F(V4l2Bandwidth, Sufficient_BestFormat) {
  bench_.video.bus_capacity = 2.1 * kYuyvTraffic;
  bench_.make();
  EXPECT_GT(bench_.run(2000).right, 40);
  EXPECT_THAT(bench_.right->report().format, HasSubstr("YUYV"));
}

TEST_F(V4l2Bandwidth, BusFull_BothFallBackToMjpeg) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  bench_.run(3000);
  const CameraBench::Frames frames = bench_.run(2000);
  EXPECT_GT(frames.left, 50);
  EXPECT_GT(frames.right, 50);
  EXPECT_EQ(bench_.left->report().format, "MJPG 64×48 at 30 Hz");
  EXPECT_EQ(bench_.right->report().format, "MJPG 64×48 at 30 Hz");
  EXPECT_THAT(bench_.log,
              testing::Contains(HasSubstr(
                  "the bus usb-0000:00:14.0 cannot carry YUYV 64×48 at 30 Hz beside the other camera's "
                  "YUYV 64×48 at 30 Hz")));
}

TEST_F(V4l2Bandwidth, BusFullWithMjpeg_LowerRate) {
  send_jpegs();
  bench_.video.bus_capacity = 0.13 * kYuyvTraffic;
  bench_.make();
  bench_.run(5000);
  const CameraBench::Frames frames = bench_.run(2000);
  EXPECT_NEAR(frames.left, 30, 3);
  EXPECT_NEAR(frames.right, 30, 3);
  EXPECT_EQ(bench_.right->report().format, "MJPG 64×48 at 15 Hz");
}

TEST_F(V4l2Bandwidth, OneStarved_BothFallBack) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.video.starve = true;
  bench_.make();
  bench_.run(12'000);
  const CameraBench::Frames frames = bench_.run(2000);
  EXPECT_GT(frames.left, 50);
  EXPECT_GT(frames.right, 50);
  EXPECT_EQ(bench_.right->report().format, "MJPG 64×48 at 30 Hz");
}

TEST_F(V4l2Bandwidth, BothStarved_BothFallBack) {
  send_jpegs();
  bench_.video.bus_capacity = 0.9 * kYuyvTraffic;
  bench_.video.starve = true;
  bench_.make();
  bench_.run(20'000);
  const CameraBench::Frames frames = bench_.run(2000);
  EXPECT_GT(frames.left, 50);
  EXPECT_GT(frames.right, 50);
}

TEST_F(V4l2Bandwidth, OnlyOtherHasFallback_OtherFallsBack) {
  for (const bool left_has_one : {true, false}) {
    CameraBench bench;
    const std::vector<std::uint8_t> jpeg = camera_jpeg(kSize, 99);
    FakeCamera& rich = left_has_one ? *bench.left_camera : *bench.right_camera;
    rich.modes = {{make_fourcc('Y', 'U', 'Y', 'V'), kSize, {30}},
                  {make_fourcc('M', 'J', 'P', 'G'), kSize, {30}}};
    rich.on_frame = [jpeg](FakeFrame& frame) { std::copy(jpeg.begin(), jpeg.end(), frame.bytes.begin()); };
    bench.video.bus_capacity = 1.5 * kYuyvTraffic;
    bench.video.starve = true;
    bench.make();
    bench.run(15'000);
    const CameraBench::Frames frames = bench.run(2000);
    EXPECT_GT(frames.left, 50) << left_has_one;
    EXPECT_GT(frames.right, 50) << left_has_one;
  }
}

TEST_F(V4l2Bandwidth, NamedFormatStarved_LoggedOnce) {
  bench_.config.v4l2.format = "yuyv";
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.video.starve = true;
  bench_.make();
  bench_.run(15'000);
  const std::size_t lines = bench_.log.size();
  for (int i = 0; i < 60; ++i) {
    bench_.run(1000);
    EXPECT_EQ(bench_.right->fault().reason, CameraReason::kNoBandwidth) << i;
  }
  EXPECT_EQ(bench_.log.size(), lines);
  EXPECT_THAT(bench_.right->report().reason, HasSubstr("set cameras.v4l2.format to mjpeg or auto"));
}

TEST_F(V4l2Bandwidth, FormatRefused_FallsBack) {
  send_jpegs();
  for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
    camera->on_set_format = [](DeviceFormat& format) {
      if (format.fourcc == make_fourcc('Y', 'U', 'Y', 'V')) format.size = {32, 24};
    };
  }
  bench_.make();
  bench_.run(6000);
  EXPECT_GT(bench_.run(2000).left, 50);
  EXPECT_EQ(bench_.left->report().format, "MJPG 64×48 at 30 Hz");
}

TEST_F(V4l2Bandwidth, SilentOnProvenBus_Stalled) {
  bench_.make();
  bench_.run(2000);
  const int right_starts = bench_.right_camera->starts;
  bench_.left_camera->frozen = true;
  bench_.run(30'000);
  EXPECT_EQ(bench_.left->report().state, SourceState::kStalled);
  EXPECT_EQ(bench_.left->fault().reason, CameraReason::kSilent);
  EXPECT_EQ(
      std::count_if(bench_.log.begin(), bench_.log.end(),
                    [](const std::string& line) { return line.find("left camera: stalled") != line.npos; }),
      1);
  EXPECT_EQ(bench_.right_camera->starts, right_starts);
  bench_.left_camera->frozen = false;
  EXPECT_GT(bench_.run(5000).left, 30);
  EXPECT_EQ(bench_.left->report().format, "YUYV 64×48 at 30 Hz");
}

TEST_F(V4l2Bandwidth, NamedFormat_KeptWithRemedy) {
  bench_.config.v4l2.format = "yuyv";
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  const CameraBench::Frames frames = bench_.run(5000);
  EXPECT_GT(frames.left, 100) << "the first camera keeps streaming";
  EXPECT_EQ(frames.right, 0);
  EXPECT_EQ(bench_.right->report().state, SourceState::kOpening);
  EXPECT_EQ(
      bench_.right->report().reason,
      "the bus usb-0000:00:14.0 cannot carry YUYV 64×48 at 30 Hz beside the other camera's YUYV 64×48 at "
      "30 Hz; set cameras.v4l2.format to mjpeg or auto, lower cameras.fps, or plug one camera into another "
      "USB controller");
  EXPECT_EQ(bench_.left_camera->starts, 1);
}

// A driver may report a full bus at any of these calls.
TEST(BandwidthSentence, EnospcAtAnyStage_NamesBus) {
  for (const unsigned long request : {VIDIOC_S_FMT, VIDIOC_S_PARM, VIDIOC_QBUF, VIDIOC_STREAMON}) {
    CameraBench bench;
    bench.config.v4l2.format = "yuyv";
    bench.right_camera->faults[request] = {ENOSPC, 1'000'000};
    bench.make();
    bench.run(1000);
    EXPECT_THAT(
        bench.right->report().reason,
        HasSubstr("the bus usb-0000:00:14.0 cannot carry YUYV 64×48 at 30 Hz beside the other camera's "
                  "YUYV 64×48 at 30 Hz; set cameras.v4l2.format to mjpeg"))
        << request;
  }
}

TEST(BandwidthSentence, EnospcWhileStreaming_NamesBus) {
  CameraBench bench;
  bench.config.v4l2.format = "yuyv";
  bench.make();
  bench.run(500);
  bench.right_camera->faults[VIDIOC_DQBUF] = {ENOSPC, 1};
  bench.run(200);
  EXPECT_THAT(bench.right->report().reason, HasSubstr("cannot carry YUYV 64×48 at 30 Hz beside"));
}

TEST_F(V4l2Bandwidth, NoFallbackLeft_KeepsTrying) {
  bench_.video.bus_capacity = 1;
  bench_.make();
  EXPECT_EQ(bench_.run(10'000).left, 0);
  EXPECT_THAT(bench_.left->report().reason, HasSubstr("plug one camera into another USB controller"));
  bench_.video.bus_capacity = 0;
  send_jpegs();
  EXPECT_GT(bench_.run(3000).left, 5);
}

TEST_F(V4l2Bandwidth, Replug_OtherUndisturbed) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  bench_.run(3000);
  const int left_starts = bench_.left_camera->starts;
  bench_.video.plug(*bench_.right_camera, false);
  bench_.run(3000);
  bench_.video.plug(*bench_.right_camera, true);
  bench_.run(3000);
  EXPECT_EQ(bench_.right->report().state, SourceState::kStreaming);
  EXPECT_EQ(bench_.right->report().format, "MJPG 64×48 at 30 Hz") << "the bus is still full";
  EXPECT_EQ(bench_.left_camera->starts, left_starts);
}

TEST_F(V4l2Bandwidth, OtherBus_BestFormatAgain) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  bench_.run(3000);
  ASSERT_EQ(bench_.left->report().format, "MJPG 64×48 at 30 Hz");
  bench_.video.plug(*bench_.right_camera, false);
  bench_.run(1000);
  bench_.right_camera->bus = "usb-0000:02:00.0-1";
  bench_.video.bus_capacity = 0;
  bench_.video.plug(*bench_.right_camera, true);
  bench_.run(3000);
  EXPECT_EQ(bench_.left->report().format, "YUYV 64×48 at 30 Hz");
  EXPECT_EQ(bench_.right->report().format, "YUYV 64×48 at 30 Hz");
  EXPECT_THAT(bench_.log, testing::Contains(HasSubstr("a camera has moved to another bus")));
  EXPECT_GT(bench_.run(2000).left, 50);
}

TEST_F(V4l2Bandwidth, BothUnplugged_BestFormatAgain) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  bench_.run(3000);
  for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) bench_.video.plug(*camera, false);
  bench_.run(3000);
  bench_.video.bus_capacity = 0;
  for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) bench_.video.plug(*camera, true);
  bench_.run(3000);
  EXPECT_EQ(bench_.left->report().format, "YUYV 64×48 at 30 Hz");
  EXPECT_EQ(bench_.right->report().format, "YUYV 64×48 at 30 Hz");
}

TEST(BusOf, UsbPort_Removed) {
  EXPECT_EQ(bus_of("usb-0000:00:14.0-3.1"), "usb-0000:00:14.0");
  EXPECT_EQ(bus_of("usb-vhci_hcd.0-1"), "usb-vhci_hcd.0");
  EXPECT_EQ(bus_of("platform:v4l2loopback-010"), "platform:v4l2loopback-010");
}

}  // namespace
}  // namespace stereod::v4l2
