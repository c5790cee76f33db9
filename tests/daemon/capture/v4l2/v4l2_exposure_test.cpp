// Controls by name, and the exposure of two cameras kept the same.
#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include "tests/support/camera_bench.h"

namespace stereod {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

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
TEST_F(Controls, WhatSomebodyElseChangesIsSetBack) {
  bench_.config.v4l2.exposure = ExposureMode::kLock;
  bench_.make();
  bench_.run(4000);
  const std::int32_t locked = value(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE);
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 500);
  set(*bench_.right_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 999);
  bench_.run(1500);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE), locked);
  EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_EXPOSURE_ABSOLUTE), locked);
}

TEST_F(Controls, ACameraThatCannotTakePartSaysSo) {
  bench_.right_camera->controls = {{V4L2_CID_BRIGHTNESS, "Brightness", 0, 255, 128, 128}};
  for (const ExposureMode mode : {ExposureMode::kLock, ExposureMode::kFollow}) {
    bench_.config.v4l2.exposure = mode;
    bench_.make();
    bench_.run(1000);
    EXPECT_THAT(bench_.right->report().note, HasSubstr("has no exposure_time_absolute"));
    EXPECT_EQ(bench_.left->report().note, "");
  }
}

// Two equal cameras in phase that stamp the end of a frame: what they expose when they are opened is not what
// they do when they have been made alike.
TEST_F(Controls, MadeAlikeTheirStampsAreTooAtTheEndOfAFrame) {
  bench_.config.v4l2.exposure = ExposureMode::kFollow;
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 20);
  set(*bench_.right_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 170);
  for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
    camera->stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
    camera->keeps_phase = true;
  }
  bench_.make();
  bench_.run(2000);
  const std::int64_t left = bench_.frame(*bench_.left).frame().captured_ns;
  const std::int64_t right = bench_.frame(*bench_.right).frame().captured_ns;
  const std::int64_t apart = std::abs(right - left) % 33'333'333;
  EXPECT_LT(std::min(apart, 33'333'333 - apart), 10'000);
}

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

}  // namespace
}  // namespace stereod
