// Two cameras as one instrument: bandwidth, exposure, phase.
#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>

#include "tests/support/camera_bench.h"
#include "tests/support/camera_jpeg.h"

namespace stereod {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr Size kSize{64, 48};
constexpr double kYuyvTraffic = 64 * 48 * 2 * 30.0;

class Bandwidth : public testing::Test {
 protected:
  Bandwidth() {
    const std::vector<std::uint8_t> jpeg = camera_jpeg(kSize, 99);
    for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
      camera->modes = {{fourcc('Y', 'U', 'Y', 'V'), kSize, {30, 15}},
                       {fourcc('M', 'J', 'P', 'G'), kSize, {30, 15, 7.5}}};
    }
  }
  void send_jpegs() {
    const std::vector<std::uint8_t> jpeg = camera_jpeg(kSize, 99);
    for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera})
      camera->on_frame = [jpeg](FakeFrame& frame) {
        // Large enough for either format, and a JPEG in front.
        std::copy(jpeg.begin(), jpeg.end(), frame.bytes.begin());
      };
  }
  CameraBench bench_;
};

TEST_F(Bandwidth, EnoughOfItKeepsTheBestFormat) {
  bench_.video.bus_capacity = 2.1 * kYuyvTraffic;
  bench_.make();
  EXPECT_GT(bench_.run(2000).right, 40);
  EXPECT_THAT(bench_.right->report().format, HasSubstr("YUYV"));
}

TEST_F(Bandwidth, AFullBusMakesBothStepDownToJpeg) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  bench_.run(3000);
  const CameraBench::Frames frames = bench_.run(2000);
  EXPECT_GT(frames.left, 50);
  EXPECT_GT(frames.right, 50);
  EXPECT_EQ(bench_.left->report().format, "MJPG 64×48 at 30/s");
  EXPECT_EQ(bench_.right->report().format, "MJPG 64×48 at 30/s");
  EXPECT_THAT(bench_.log,
              testing::Contains(HasSubstr(
                  "the bus usb-0000:00:14.0 cannot carry YUYV 64×48 at 30/s beside the other camera's "
                  "YUYV 64×48 at 30/s")));
}

TEST_F(Bandwidth, AndThenToALowerRate) {
  send_jpegs();
  bench_.video.bus_capacity = 0.13 * kYuyvTraffic;
  bench_.make();
  bench_.run(5000);
  const CameraBench::Frames frames = bench_.run(2000);
  EXPECT_NEAR(frames.left, 30, 3);
  EXPECT_NEAR(frames.right, 30, 3);
  EXPECT_EQ(bench_.right->report().format, "MJPG 64×48 at 15/s");
}

TEST_F(Bandwidth, StreamsThatNeverDeliverStepDownToo) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.video.starve = true;
  bench_.make();
  bench_.run(12'000);
  const CameraBench::Frames frames = bench_.run(2000);
  EXPECT_GT(frames.left, 50);
  EXPECT_GT(frames.right, 50);
  EXPECT_EQ(bench_.right->report().format, "MJPG 64×48 at 30/s");
}

TEST_F(Bandwidth, ASilentCameraThatHasStreamedHereIsNotTakenForAFullBus) {
  bench_.make();
  bench_.run(2000);
  const int right_starts = bench_.right_camera->starts;
  bench_.left_camera->frozen = true;
  bench_.run(30'000);
  EXPECT_EQ(bench_.left->report().state, "wedged");
  EXPECT_EQ(bench_.left->fault().reason, CameraReason::kSilent);
  EXPECT_EQ(std::count_if(bench_.log.begin(), bench_.log.end(),
                          [](const std::string& line) { return line.find("left camera is") != line.npos; }),
            1);
  EXPECT_EQ(bench_.right_camera->starts, right_starts);
  bench_.left_camera->frozen = false;
  EXPECT_GT(bench_.run(5000).left, 30);
  EXPECT_EQ(bench_.left->report().format, "YUYV 64×48 at 30/s");
}

TEST_F(Bandwidth, ANamedFormatIsKeptAndTheRemedySaid) {
  bench_.config.v4l2.format = "yuyv";
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  const CameraBench::Frames frames = bench_.run(5000);
  EXPECT_GT(frames.left, 100) << "the first camera goes on";
  EXPECT_EQ(frames.right, 0);
  EXPECT_EQ(bench_.right->report().state, "opening");
  EXPECT_EQ(
      bench_.right->report().reason,
      "the bus usb-0000:00:14.0 cannot carry YUYV 64×48 at 30/s beside the other camera's YUYV 64×48 at "
      "30/s; set cameras.v4l2.format to mjpeg or auto, lower cameras.fps, or plug one camera into another "
      "USB controller");
  EXPECT_EQ(bench_.left_camera->starts, 1);
}

// Wherever the driver notices that the bus is full.
TEST(BandwidthSentence, IsSaidAtEveryStep) {
  for (const unsigned long request : {VIDIOC_S_FMT, VIDIOC_S_PARM, VIDIOC_QBUF, VIDIOC_STREAMON}) {
    CameraBench bench;
    bench.config.v4l2.format = "yuyv";
    bench.right_camera->faults[request] = {ENOSPC, 1'000'000};
    bench.make();
    bench.run(1000);
    EXPECT_THAT(
        bench.right->report().reason,
        HasSubstr("the bus usb-0000:00:14.0 cannot carry YUYV 64×48 at 30/s beside the other camera's "
                  "YUYV 64×48 at 30/s; set cameras.v4l2.format to mjpeg"))
        << request;
  }
}

TEST(BandwidthSentence, IsSaidOfAStreamThatFails) {
  CameraBench bench;
  bench.config.v4l2.format = "yuyv";
  bench.make();
  bench.run(500);
  bench.right_camera->faults[VIDIOC_DQBUF] = {ENOSPC, 1};
  bench.run(200);
  EXPECT_THAT(bench.right->report().reason, HasSubstr("cannot carry YUYV 64×48 at 30/s beside"));
}

TEST_F(Bandwidth, WithNoStepLeftItSaysSoAndGoesOnTrying) {
  bench_.video.bus_capacity = 1;
  bench_.make();
  EXPECT_EQ(bench_.run(10'000).left, 0);
  EXPECT_THAT(bench_.left->report().reason, HasSubstr("plug one camera into another USB controller"));
  bench_.video.bus_capacity = 0;
  send_jpegs();
  EXPECT_GT(bench_.run(3000).left, 5);
}

TEST_F(Bandwidth, ACameraThatComesBackDoesNotDisturbTheOther) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  bench_.run(3000);
  const int left_starts = bench_.left_camera->starts;
  bench_.video.plug(*bench_.right_camera, false);
  bench_.run(3000);
  bench_.video.plug(*bench_.right_camera, true);
  bench_.run(3000);
  EXPECT_EQ(bench_.right->report().state, "streaming");
  EXPECT_EQ(bench_.right->report().format, "MJPG 64×48 at 30/s") << "the bus is as full as it was";
  EXPECT_EQ(bench_.left_camera->starts, left_starts);
}

TEST_F(Bandwidth, OnAnotherBusBothBeginAnewWithTheBest) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  bench_.run(3000);
  ASSERT_EQ(bench_.left->report().format, "MJPG 64×48 at 30/s");
  bench_.video.plug(*bench_.right_camera, false);
  bench_.run(1000);
  bench_.right_camera->bus = "usb-0000:02:00.0-1";
  bench_.video.bus_capacity = 0;
  bench_.video.plug(*bench_.right_camera, true);
  bench_.run(3000);
  EXPECT_EQ(bench_.left->report().format, "YUYV 64×48 at 30/s");
  EXPECT_EQ(bench_.right->report().format, "YUYV 64×48 at 30/s");
  EXPECT_THAT(bench_.log, testing::Contains(HasSubstr("a camera has moved to another bus")));
  EXPECT_GT(bench_.run(2000).left, 50);
}

TEST_F(Bandwidth, WithBothGoneTheNextBeginWithTheBest) {
  send_jpegs();
  bench_.video.bus_capacity = 1.5 * kYuyvTraffic;
  bench_.make();
  bench_.run(3000);
  for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) bench_.video.plug(*camera, false);
  bench_.run(3000);
  bench_.video.bus_capacity = 0;
  for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) bench_.video.plug(*camera, true);
  bench_.run(3000);
  EXPECT_EQ(bench_.left->report().format, "YUYV 64×48 at 30/s");
  EXPECT_EQ(bench_.right->report().format, "YUYV 64×48 at 30/s");
}

TEST(BusOf, LeavesThePortOut) {
  EXPECT_EQ(bus_of("usb-0000:00:14.0-3.1"), "usb-0000:00:14.0");
  EXPECT_EQ(bus_of("usb-vhci_hcd.0-1"), "usb-vhci_hcd.0");
  EXPECT_EQ(bus_of("platform:v4l2loopback-010"), "platform:v4l2loopback-010");
}

std::vector<FakeControl> uvc_controls() {
  return {
      {V4L2_CID_BRIGHTNESS, "Brightness", 0, 255, 128, 128},
      {V4L2_CID_GAIN, "Gain", 0, 100, 10, 10},
      {V4L2_CID_POWER_LINE_FREQUENCY, "Power Line Frequency", 0, 2, 0, 0, V4L2_CTRL_TYPE_MENU},
      {V4L2_CID_AUTO_WHITE_BALANCE, "White Balance, Automatic", 0, 1, 1, 1, V4L2_CTRL_TYPE_BOOLEAN},
      {V4L2_CID_WHITE_BALANCE_TEMPERATURE, "White Balance Temperature", 2000, 7000, 4000, 4000},
      {V4L2_CID_EXPOSURE_AUTO, "Auto Exposure", 0, 3, 3, 3, V4L2_CTRL_TYPE_MENU},
      {V4L2_CID_EXPOSURE_ABSOLUTE, "Exposure Time, Absolute", 3, 2047, 250, 250},
      {V4L2_CID_EXPOSURE_AUTO_PRIORITY, "Exposure, Dynamic Framerate", 0, 1, 1, 1, V4L2_CTRL_TYPE_BOOLEAN}};
}

class Controls : public testing::Test {
 protected:
  Controls() { bench_.left_camera->controls = bench_.right_camera->controls = uvc_controls(); }
  static std::int32_t value(const FakeCamera& camera, std::uint32_t id) {
    for (const FakeControl& control : camera.controls)
      if (control.id == id) return control.value;
    return -1;
  }
  static void set(FakeCamera& camera, std::uint32_t id, std::int32_t to) {
    for (FakeControl& control : camera.controls)
      if (control.id == id) control.value = to;
  }
  CameraBench bench_;
};

TEST_F(Controls, AutomaticModesGoOffBeforeTheirValuesAreSet) {
  bench_.config.v4l2.controls = {{"exposure_time_absolute", 120}, {"white_balance_temperature", 5000}};
  bench_.config.v4l2.left_controls = {{"gain", 33}};
  bench_.make();
  bench_.run(500);
  EXPECT_THAT(bench_.left_camera->log,
              ElementsAre("Exposure, Dynamic Framerate=0", "Auto Exposure=1", "Exposure Time, Absolute=120",
                          "Gain=33", "White Balance, Automatic=0", "White Balance Temperature=5000"));
  EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_GAIN), 10) << "left_controls are the left camera's";
  EXPECT_EQ(bench_.left->report().note, "");
}

TEST_F(Controls, DifferencesAreReported) {
  bench_.config.v4l2.controls = {{"gain", 300}, {"sharpness", 3}};
  bench_.make();
  bench_.run(500);
  EXPECT_EQ(bench_.left->report().note,
            "gain was set to 300 and is 100, allowed are 0 to 100; it has no control sharpness");
  EXPECT_EQ(bench_.left->report().state, "streaming") << "a control is no reason not to stream";
}

TEST_F(Controls, ErrorsAreReported) {
  bench_.config.v4l2.controls = {{"brightness", 99}};
  bench_.left_camera->faults[VIDIOC_S_CTRL] = {EIO, 1, 1};  // after the lengthening of exposure
  bench_.right_camera->faults[VIDIOC_G_CTRL] = {EIO, 1};
  bench_.make();
  bench_.run(500);
  EXPECT_EQ(bench_.left->report().note,
            "brightness could not be set to 99 (Input/output error), allowed are 0 to 255");
  EXPECT_EQ(bench_.right->report().note,
            "brightness was set to 99 and cannot be read back (Input/output error)");
}

TEST_F(Controls, NamesOfOtherKernelsAreUnderstood) {
  bench_.config.v4l2.controls = {{"exposure_absolute", 99}, {"exposure_auto_priority", 1}};
  bench_.make();
  bench_.run(500);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE), 99);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO_PRIORITY), 1);
  EXPECT_EQ(bench_.left->report().note, "");
}

TEST_F(Controls, AModeThatTheConfigurationNamesIsKept) {
  bench_.config.v4l2.controls = {{"auto_exposure", 3}, {"exposure_time_absolute", 99}};
  bench_.make();
  bench_.run(500);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO), 3);
}

TEST_F(Controls, AreSetAgainAfterAReplug) {
  bench_.config.v4l2.controls = {{"gain", 42}};
  bench_.make();
  bench_.run(500);
  bench_.video.plug(*bench_.left_camera, false);
  bench_.run(500);
  set(*bench_.left_camera, V4L2_CID_GAIN, 7);
  bench_.video.plug(*bench_.left_camera, true);
  bench_.run(1000);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_GAIN), 42);
}

TEST_F(Controls, FollowCopiesTheLeftCamerasExposure) {
  bench_.config.v4l2.exposure = ExposureMode::kFollow;
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO, 1);  // as another program left it
  bench_.make();
  bench_.run(1000);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO), 3) << "the left automation works";
  EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_EXPOSURE_AUTO), 1);
  for (const int exposure : {500, 80}) {
    set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, exposure);
    set(*bench_.left_camera, V4L2_CID_GAIN, exposure / 10);
    bench_.run(1500);
    EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_EXPOSURE_ABSOLUTE), exposure);
    EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_GAIN), exposure / 10);
  }
  EXPECT_EQ(bench_.right->report().note, "");
}

TEST_F(Controls, LockSettlesAndThenKeepsBothTheSame) {
  bench_.config.v4l2.exposure = ExposureMode::kLock;
  bench_.make();
  bench_.run(1500);
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 333);  // what its automation came to
  bench_.run(3000);
  for (const FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
    EXPECT_EQ(value(*camera, V4L2_CID_EXPOSURE_AUTO), 1);
    EXPECT_EQ(value(*camera, V4L2_CID_EXPOSURE_ABSOLUTE), 333);
  }
  bench_.video.plug(*bench_.left_camera, false);
  bench_.run(500);
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO, 3);
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 5);
  bench_.video.plug(*bench_.left_camera, true);
  bench_.run(2000);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE), 333) << "for good";
}

TEST_F(Controls, ANamedExposureIsKeptAndTheGainIsStillLocked) {
  bench_.config.v4l2.exposure = ExposureMode::kLock;
  bench_.config.v4l2.controls = {{"exposure_time_absolute", 120}};
  for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera})
    camera->controls.push_back({V4L2_CID_AUTOGAIN, "Gain, Automatic", 0, 1, 1, 1, V4L2_CTRL_TYPE_BOOLEAN});
  bench_.make();
  bench_.run(1500);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_AUTOGAIN), 1) << "for two seconds";
  set(*bench_.left_camera, V4L2_CID_GAIN, 55);
  bench_.run(3000);
  for (const FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
    EXPECT_EQ(value(*camera, V4L2_CID_EXPOSURE_AUTO), 1);
    EXPECT_EQ(value(*camera, V4L2_CID_EXPOSURE_ABSOLUTE), 120);
    EXPECT_EQ(value(*camera, V4L2_CID_AUTOGAIN), 0);
    EXPECT_EQ(value(*camera, V4L2_CID_GAIN), 55);
  }
  EXPECT_EQ(bench_.right->report().note, "");
}

TEST_F(Controls, ANoteStandsForAsLongAsItIsTrue) {
  bench_.config.v4l2.exposure = ExposureMode::kFollow;
  bench_.config.v4l2.controls = {{"sharpness", 3}};
  for (FakeControl& control : bench_.right_camera->controls)
    if (control.id == V4L2_CID_EXPOSURE_ABSOLUTE) control.most = 100;
  bench_.make();
  bench_.run(1500);
  EXPECT_THAT(bench_.right->report().note,
              HasSubstr("it has no control sharpness; its exposure does not take"));
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 90);
  bench_.run(1500);
  EXPECT_EQ(bench_.right->report().note, "it has no control sharpness");
  EXPECT_EQ(std::count_if(
                bench_.log.begin(), bench_.log.end(),
                [](const std::string& line) { return line.find("right camera: it has no") != line.npos; }),
            1 + 1)
      << "at the start, and with the exposure";
}

TEST_F(Controls, AnExposureThatDoesNotTakeIsReportedOnce) {
  bench_.config.v4l2.exposure = ExposureMode::kFollow;
  for (FakeControl& control : bench_.right_camera->controls)
    if (control.id == V4L2_CID_EXPOSURE_ABSOLUTE) control.most = 100;
  bench_.make();
  bench_.run(1500);
  EXPECT_EQ(
      bench_.right->report().note,
      "its exposure does not take the left camera's values: exposure_time_absolute should be 250 and is 100");
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 400);
  bench_.run(3000);
  EXPECT_EQ(std::count_if(bench_.log.begin(), bench_.log.end(),
                          [](const std::string& line) { return line.find("does not take") != line.npos; }),
            1);
}

// A control that cannot be read or set for a moment is asked for again.
TEST_F(Controls, AnErrorThatPassesDoesNotEndLockOrFollow) {
  for (const ExposureMode mode : {ExposureMode::kLock, ExposureMode::kFollow}) {
    for (const bool reading : {true, false}) {
      SCOPED_TRACE(testing::Message() << (mode == ExposureMode::kLock ? "lock" : "follow")
                                      << (reading ? ", reading" : ", setting"));
      CameraBench bench;
      bench.left_camera->controls = bench.right_camera->controls = uvc_controls();
      set(*bench.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 333);
      set(*bench.left_camera, V4L2_CID_GAIN, 44);
      bench.config.v4l2.exposure = mode;
      bench.make();
      bench.run(mode == ExposureMode::kLock ? 1600 : 100);
      // The left camera's values when they are first wanted; the right one's way out of its automatic mode.
      if (reading) bench.left_camera->faults[VIDIOC_G_CTRL] = {EIO, 1};
      if (!reading) bench.right_camera->faults[VIDIOC_S_CTRL] = {EIO, 1};
      bench.run(4000);
      EXPECT_EQ(value(*bench.right_camera, V4L2_CID_EXPOSURE_AUTO), 1);
      EXPECT_EQ(value(*bench.right_camera, V4L2_CID_EXPOSURE_ABSOLUTE), 333);
      EXPECT_EQ(value(*bench.right_camera, V4L2_CID_GAIN), 44);
    }
  }
}

class Phase : public testing::Test {
 protected:
  Phase() {
    bench_.config.v4l2.align = AlignMode::kStart;
    bench_.left_camera->start_latency_ns = 200'000'000;
    bench_.right_camera->start_latency_ns = 216'000'000;  // 16 ms apart
  }
  CameraBench bench_;
};

TEST_F(Phase, ComesFromSixteenMillisecondsBelowThree) {
  bench_.make();
  bench_.run(8000);
  const PhaseReport phase = bench_.pair->phase();
  EXPECT_EQ(phase.state, PhaseState::kAligned);
  EXPECT_LT(std::abs(phase.skew_ms), 3);
  EXPECT_GE(phase.restarts, 1);
  EXPECT_EQ(bench_.left_camera->starts, 1) << "the left stream goes on";
  EXPECT_EQ(bench_.right_camera->starts, 1 + phase.restarts);
  const CameraBench::Frames frames = bench_.run(3000);
  EXPECT_GE(frames.right, 85) << "and then is left alone";
}

// Crystals 20 ppm apart: six milliseconds in five minutes.
TEST_F(Phase, AnHourOfDriftIsFollowed) {
  bench_.config.v4l2.align = AlignMode::kAlways;
  bench_.right_camera->drift_ppb = 20'000;
  bench_.make();
  bench_.run(8000);
  ASSERT_EQ(bench_.pair->phase().state, PhaseState::kAligned);
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
  EXPECT_EQ(bench_.pair->phase().state, PhaseState::kAligned);
  EXPECT_EQ(held.frame().luma.data[0], held.frame().sequence);
  held.end();
  EXPECT_GE(bench_.run(3000).right, 85);
}

TEST_F(Phase, ARestartThatFailsIsAFaultLikeAnyOther) {
  bench_.make();
  bench_.right_camera->faults[VIDIOC_STREAMON] = {EIO, 1, 1};
  bench_.run(10'000);
  EXPECT_EQ(bench_.right->report().reconnects, 1);
  EXPECT_EQ(bench_.pair->phase().state, PhaseState::kAligned);
}

TEST_F(Phase, ARestartThatFindsTheBusFullSaysSo) {
  bench_.config.v4l2.format = "yuyv";
  bench_.make();
  bench_.right_camera->faults[VIDIOC_STREAMON] = {ENOSPC, 1, 1};
  bench_.run(10'000);
  EXPECT_THAT(bench_.right->report().last_fault, HasSubstr("cannot carry YUYV 64×48 at 30/s beside"));
  EXPECT_EQ(bench_.pair->phase().state, PhaseState::kAligned);
}

TEST_F(Phase, ACameraThatComesBackIsAlignedWithoutTouchingTheOther) {
  bench_.make();
  bench_.run(8000);
  bench_.video.plug(*bench_.left_camera, false);
  bench_.run(1000);
  const int right_starts = bench_.right_camera->starts;
  bench_.video.plug(*bench_.left_camera, true);
  bench_.run(8000);
  EXPECT_EQ(bench_.pair->phase().state, PhaseState::kAligned);
  EXPECT_EQ(bench_.right_camera->starts, right_starts);
}

TEST_F(Phase, SensorsThatRunOnAreReportedAsTheyAre) {
  bench_.left_camera->keeps_phase = bench_.right_camera->keeps_phase = true;
  bench_.right_camera->phase_ns = 10'000'000;
  bench_.make();
  bench_.run(15'000);
  const PhaseReport phase = bench_.pair->phase();
  EXPECT_EQ(phase.state, PhaseState::kGivenUp);
  EXPECT_NEAR(phase.skew_ms, 10, 0.1);
  EXPECT_EQ(phase.restarts, 3);
  EXPECT_GE(bench_.run(3000).right, 85);
}

TEST_F(Phase, NeverLeavesThemAlone) {
  bench_.config.v4l2.align = AlignMode::kNever;
  bench_.make();
  bench_.run(5000);
  EXPECT_EQ(bench_.pair->phase().state, PhaseState::kOff);
  EXPECT_NE(bench_.pair->phase().skew_ms, 0);
  EXPECT_EQ(bench_.right_camera->starts, 1);
}

}  // namespace
}  // namespace stereod
