// SPDX-License-Identifier: BSD-3-Clause
// Controls by name, and equal exposure of two cameras.
#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include "tests/support/camera_bench.h"

namespace stereod::v4l2 {
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

class V4l2Controls : public testing::Test {
 protected:
  V4l2Controls() { bench_.left_camera->controls = bench_.right_camera->controls = uvc_controls(); }
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

TEST_F(V4l2Controls, Values_AutoModesDisabledFirst) {
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

TEST_F(V4l2Controls, ValueNotAccepted_Noted) {
  bench_.config.v4l2.controls = {{"gain", 300}, {"sharpness", 3}};
  bench_.make();
  bench_.run(500);
  EXPECT_EQ(bench_.left->report().note,
            "gain: set to 300, reads back 100 (range 0…100); no control named sharpness");
  EXPECT_EQ(bench_.left->report().state, SourceState::kStreaming) << "a control does not stop the stream";
}

TEST_F(V4l2Controls, CallFails_Noted) {
  bench_.config.v4l2.controls = {{"brightness", 99}};
  bench_.left_camera->faults[VIDIOC_S_CTRL] = {EIO, 1, 1};  // after the lengthening of exposure
  bench_.right_camera->faults[VIDIOC_G_CTRL] = {EIO, 1};
  bench_.make();
  bench_.run(500);
  EXPECT_EQ(bench_.left->report().note, "brightness: cannot be set to 99: Input/output error (range 0…255)");
  EXPECT_EQ(bench_.right->report().note, "brightness: set to 99, cannot be read back: Input/output error");
}

TEST_F(V4l2Controls, OldNames_Accepted) {
  bench_.config.v4l2.controls = {{"exposure_absolute", 99}, {"exposure_auto_priority", 1}};
  bench_.make();
  bench_.run(500);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE), 99);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO_PRIORITY), 1);
  EXPECT_EQ(bench_.left->report().note, "");
}

TEST_F(V4l2Controls, NamedMode_Kept) {
  bench_.config.v4l2.controls = {{"auto_exposure", 3}, {"exposure_time_absolute", 99}};
  bench_.make();
  bench_.run(500);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO), 3);
}

TEST_F(V4l2Controls, Replug_SetAgain) {
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

TEST_F(V4l2Controls, Follow_CopiesLeftExposure) {
  bench_.config.v4l2.exposure = ExposureMode::kFollow;
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO, 1);  // left so by another program
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

TEST_F(V4l2Controls, Lock_KeepsBothTheSame) {
  bench_.config.v4l2.exposure = ExposureMode::kLock;
  bench_.make();
  bench_.run(1500);
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 333);  // found by its automatic mode
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

TEST_F(V4l2Controls, NamedExposure_GainStillLocked) {
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

TEST_F(V4l2Controls, Note_WithdrawnWhenSolved) {
  bench_.config.v4l2.exposure = ExposureMode::kFollow;
  bench_.config.v4l2.controls = {{"sharpness", 3}};
  for (FakeControl& control : bench_.right_camera->controls)
    if (control.id == V4L2_CID_EXPOSURE_ABSOLUTE) control.maximum = 100;
  bench_.make();
  bench_.run(1500);
  EXPECT_THAT(bench_.right->report().note, HasSubstr("no control named sharpness; the exposure differs"));
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 90);
  bench_.run(1500);
  EXPECT_EQ(bench_.right->report().note, "no control named sharpness");
  EXPECT_EQ(std::count_if(
                bench_.log.begin(), bench_.log.end(),
                [](const std::string& line) { return line.find("right camera: no control") != line.npos; }),
            1 + 1)
      << "at the start, and with the exposure";
}

TEST_F(V4l2Controls, ExposureNotAccepted_LoggedOnce) {
  bench_.config.v4l2.exposure = ExposureMode::kFollow;
  for (FakeControl& control : bench_.right_camera->controls)
    if (control.id == V4L2_CID_EXPOSURE_ABSOLUTE) control.maximum = 100;
  bench_.make();
  bench_.run(1500);
  EXPECT_EQ(bench_.right->report().note,
            "the exposure differs from the left camera's: exposure_time_absolute is 100, should be 250");
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 400);
  bench_.run(3000);
  EXPECT_EQ(std::count_if(bench_.log.begin(), bench_.log.end(),
                          [](const std::string& line) { return line.find("exposure differs") != line.npos; }),
            1);
}

// Values that another program changes are restored.
TEST_F(V4l2Controls, ChangedByOthers_SetBack) {
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

TEST_F(V4l2Controls, NoExposureControl_Noted) {
  bench_.right_camera->controls = {{V4L2_CID_BRIGHTNESS, "Brightness", 0, 255, 128, 128}};
  for (const ExposureMode mode : {ExposureMode::kLock, ExposureMode::kFollow}) {
    bench_.config.v4l2.exposure = mode;
    bench_.make();
    bench_.run(1000);
    EXPECT_THAT(bench_.right->report().note, HasSubstr("no control named exposure_time_absolute"));
    EXPECT_EQ(bench_.left->report().note, "");
  }
}

// Two equal cameras in phase with timestamps of the end of the frame: their exposure at opening is not the
// one they are set to later.
TEST_F(V4l2Controls, FollowWithEndOfFrame_SameTimestamps) {
  bench_.config.v4l2.exposure = ExposureMode::kFollow;
  set(*bench_.left_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 20);
  set(*bench_.right_camera, V4L2_CID_EXPOSURE_ABSOLUTE, 170);
  for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
    camera->timestamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
    camera->keeps_phase = true;
  }
  bench_.make();
  bench_.run(2000);
  const std::int64_t left = bench_.frame(*bench_.left).frame().captured_ns;
  const std::int64_t right = bench_.frame(*bench_.right).frame().captured_ns;
  const std::int64_t apart = std::abs(right - left) % 33'333'333;
  EXPECT_LT(std::min(apart, 33'333'333 - apart), 10'000);
}

TEST_F(V4l2Controls, TransientError_LockAndFollowContinue) {
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
      // The first reading of the left camera's values; the right camera's change to manual exposure.
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
}  // namespace stereod::v4l2
