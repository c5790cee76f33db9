// SPDX-License-Identifier: BSD-3-Clause
// Settings that change while cameras stream.
#include <gmock/gmock.h>
#include <linux/v4l2-controls.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "daemon/pipeline/pipeline.h"
#include "tests/support/camera_bench.h"

namespace stereod::v4l2 {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

FakeControl control(std::uint32_t id, const char* title, int maximum, int default_value) {
  FakeControl made;
  made.id = id;
  made.title = title;
  made.maximum = maximum;
  made.default_value = made.value = default_value;
  return made;
}

int value(const FakeCamera& camera, std::uint32_t id) {
  const auto found = std::find_if(camera.controls.begin(), camera.controls.end(),
                                  [&](const FakeControl& each) { return each.id == id; });
  return found == camera.controls.end() ? -1 : found->value;
}

class V4l2Reload : public testing::Test {
 protected:
  V4l2Reload() {
    for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
      camera->controls = {control(V4L2_CID_EXPOSURE_AUTO, "Auto Exposure", 3, 3),
                          control(V4L2_CID_EXPOSURE_ABSOLUTE, "Exposure Time, Absolute", 1000, 250),
                          control(V4L2_CID_GAIN, "Gain", 100, 32),
                          control(V4L2_CID_BRIGHTNESS, "Brightness", 255, 128)};
    }
  }
  void expect_it_streamed_on() {
    for (const FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
      EXPECT_EQ(camera->starts, 1);
      EXPECT_EQ(camera->opens, opens_before_);
    }
    EXPECT_EQ(bench_.left->report().reconnects, 0);
  }
  void run_a_while() {
    bench_.make();
    bench_.run(1000);
    opens_before_ = bench_.left_camera->opens;
    ASSERT_EQ(bench_.right_camera->opens, opens_before_);
  }
  CameraBench bench_;
  int opens_before_ = 0;
};

TEST_F(V4l2Reload, NewControls_SetWhileStreaming) {
  bench_.config.v4l2.controls = {{"gain", 10}};
  run_a_while();
  V4l2Config other = bench_.config.v4l2;
  other.controls = {{"gain", 50}};
  other.right_controls = {{"brightness", 7}};
  bench_.pair->set_controls(other);
  const CameraBench::Frames frames = bench_.run(1000);
  EXPECT_GE(frames.left, 28);
  EXPECT_GE(frames.right, 28);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_GAIN), 50);
  EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_GAIN), 50);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_BRIGHTNESS), 128);
  EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_BRIGHTNESS), 7);
  expect_it_streamed_on();
}

TEST_F(V4l2Reload, RemovedControls_ResetToDefault) {
  bench_.config.v4l2.controls = {{"gain", 10}, {"exposure_time_absolute", 99}};
  run_a_while();
  ASSERT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO), 1) << "manual, so that the value applies";
  V4l2Config other = bench_.config.v4l2;
  other.controls.clear();
  bench_.pair->set_controls(other);
  bench_.run(500);
  for (const FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
    EXPECT_EQ(value(*camera, V4L2_CID_GAIN), 32);
    EXPECT_EQ(value(*camera, V4L2_CID_EXPOSURE_ABSOLUTE), 250);
    EXPECT_EQ(value(*camera, V4L2_CID_EXPOSURE_AUTO), 3);
  }
  expect_it_streamed_on();
}

TEST_F(V4l2Reload, ValueOutOfRange_Noted) {
  run_a_while();
  V4l2Config other = bench_.config.v4l2;
  other.controls = {{"gain", 300}};
  bench_.pair->set_controls(other);
  bench_.run(500);
  EXPECT_EQ(bench_.left->report().note, "gain: set to 300, reads back 100 (range 0…100)");
  bench_.pair->set_controls(bench_.config.v4l2);
  bench_.run(500);
  EXPECT_EQ(bench_.left->report().note, "");
}

TEST_F(V4l2Reload, FollowToAuto_BothAutomatic) {
  bench_.config.v4l2.exposure = ExposureMode::kFollow;
  run_a_while();
  ASSERT_EQ(value(*bench_.right_camera, V4L2_CID_EXPOSURE_AUTO), 1);
  V4l2Config other = bench_.config.v4l2;
  other.exposure = ExposureMode::kAuto;
  bench_.pair->set_controls(other);
  bench_.run(500);
  EXPECT_EQ(value(*bench_.left_camera, V4L2_CID_EXPOSURE_AUTO), 3);
  EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_EXPOSURE_AUTO), 3);
  expect_it_streamed_on();
}

TEST_F(V4l2Reload, UnpluggedCamera_SetAfterReplug) {
  bench_.config.v4l2.controls = {{"gain", 10}};
  run_a_while();
  bench_.video.plug(*bench_.right_camera, false);
  bench_.run(500);
  V4l2Config other = bench_.config.v4l2;
  other.controls = {{"gain", 60}};
  bench_.pair->set_controls(other);
  bench_.run(500);
  EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_GAIN), 10);
  bench_.video.plug(*bench_.right_camera, true);
  bench_.run(3000);
  EXPECT_EQ(value(*bench_.right_camera, V4L2_CID_GAIN), 60);
}

class CountingBus final : public MessageBus {
 public:
  bool publish(const char* channel, const void*, std::size_t) noexcept override {
    if (std::string_view(channel).ends_with("_FRAME")) ++frames_;
    return true;
  }
  void wait_for_more_frames(int count) const {
    const int enough = frames_ + count;
    while (frames_ < enough) std::this_thread::sleep_for(1ms);
  }

 private:
  std::atomic<int> frames_{0};
};

// In real time, with the pipeline's threads.
TEST(PipelineTakeOver, SameCameras_KeepStreaming) {
  Config config;
  CameraBench bench(true);
  config.cameras = bench.config;
  config.cameras.fps = 100;
  for (FakeCamera* camera : {bench.left_camera, bench.right_camera}) {
    camera->modes = {{make_fourcc('Y', 'U', 'Y', 'V'), {64, 48}, {100}}};
    camera->start_latency_ns = 3'000'000;
  }
  config.matcher.disparities = 8;
  config.workers = 2;
  CountingBus bus;
  const CameraLog no_log = [](LogLevel, const std::string&) {};
  const auto rig = [&] {
    StereoSource made;
    const auto pair = std::make_shared<V4l2PairState>(config.cameras);
    made.left = std::make_unique<V4l2Camera>(bench.video, pair, Side::kLeft, config.cameras, no_log);
    made.right = std::make_unique<V4l2Camera>(bench.video, pair, Side::kRight, config.cameras, no_log);
    made.cameras = pair;
    return made;
  };
  auto pipeline = std::make_unique<Pipeline>(config, rig(), bus);
  bus.wait_for_more_frames(5);
  for (const int disparities : {16, 24, 40}) {
    config.matcher.disparities = disparities;
    auto next = std::make_unique<Pipeline>(config, std::nullopt, pipeline->cameras(), bus);
    next->take_over(*pipeline);
    pipeline = std::move(next);
    bus.wait_for_more_frames(5);
  }
  EXPECT_EQ(bench.left_camera->starts, 1);
  EXPECT_EQ(bench.right_camera->starts, 1);
  const std::int64_t frames = pipeline->take_stats().left.frames;
  EXPECT_GE(frames, 20);
  auto next = std::make_unique<Pipeline>(config, std::nullopt,
                                         std::make_shared<StereoCapture>(config.cameras, rig()), bus);
  next->take_over(*pipeline);
  pipeline = std::move(next);
  bus.wait_for_more_frames(5);
  EXPECT_EQ(bench.left_camera->starts, 2);
  EXPECT_GE(pipeline->take_stats().left.frames, frames + 5);
  EXPECT_GE(pipeline->frames_published(), 25);
  pipeline.reset();
  EXPECT_EQ(bench.video.open_descriptors(), 0);
  EXPECT_EQ(bench.video.mappings(), 0);
}

// A pipeline that never took over changes nothing.
TEST(PipelineTakeOver, Discarded_NoEffect) {
  Config config;
  config.cameras.fps = 0;
  config.cameras.width = 160;
  config.cameras.height = 120;
  CountingBus bus;
  Pipeline pipeline(config, open_stereo_source(config), bus);
  bus.wait_for_more_frames(2);
  { const Pipeline discarded(config, pipeline.calibration(), pipeline.cameras(), bus); }
  bus.wait_for_more_frames(5);
}

}  // namespace
}  // namespace stereod::v4l2
