// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/status_reporter.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "tests/support/keeping_bus.h"

namespace stereod {
namespace {

Config small_scene() {
  Config config;
  config.cameras.source = SourceKind::kSynthetic;
  config.cameras.fps = 0;
  config.cameras.width = 160;
  config.cameras.height = 120;
  config.matcher = *matcher_preset("fast");
  config.workers = 1;
  config.lcm.prefix = "T";
  config.lcm.pacing = 0;
  return config;
}

TEST(StatusReporter, FirstFrames_StartingThenStreaming) {
  const Config config = small_scene();
  KeepingBus<status_t> bus("T_STATUS");
  Pipeline pipeline(config, open_stereo_source(config), bus);
  StatusReporter reporter(pipeline, bus);
  reporter.report();
  EXPECT_EQ(reporter.state(), ServiceState::kStarting);
  // Some of these frames may have been published before the first report.
  const std::size_t enough = bus.frames().size() + 4;
  while (bus.frames().size() < enough) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  reporter.report();
  EXPECT_EQ(reporter.state(), ServiceState::kStreaming);
  const std::vector<status_t> messages = bus.messages();
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].state, "starting");
  EXPECT_EQ(messages[1].state, "streaming");
  EXPECT_EQ(messages[1].reason, "");
  EXPECT_GE(messages[1].frames_published, 2);
  EXPECT_EQ(messages[1].left.device, "synthetic scene");
  EXPECT_EQ(messages[1].left.decode_errors, 0);
  EXPECT_GT(messages[1].rss_mb, 1);
}

TEST(StatusReporter, OtherPipeline_CameraInfoSentAtOnce) {
  const Config config = small_scene();
  KeepingBus<camera_info_t> bus("T_CAMERA_INFO");
  Pipeline pipeline(config, open_stereo_source(config), bus);
  StatusReporter reporter(pipeline, bus);
  ASSERT_EQ(bus.messages().size(), 1u);
  reporter.follow(pipeline, bus);
  ASSERT_EQ(bus.messages().size(), 2u);
  EXPECT_EQ(bus.messages()[1].width, 160);
  EXPECT_EQ(bus.messages()[1].calibration_id, bus.messages()[0].calibration_id);
}

TEST(JudgeState, SomethingMissing_NamedCause) {
  const auto judge = [](bool left, bool right, bool pairs, bool published, bool refused, bool calibrated) {
    return judge_state({left, right, pairs, published, refused}, calibrated);
  };
  const auto reason = [](const ServiceCondition& condition) { return describe(condition.cause); };
  const auto name = [](const ServiceCondition& condition) { return name_of(condition.state); };
  EXPECT_EQ(reason(judge(false, false, false, false, false, true)), "no frames from either camera");
  EXPECT_EQ(reason(judge(false, true, false, false, false, true)), "no frames from the left camera");
  EXPECT_EQ(name(judge(true, false, false, false, false, true)), "waiting_for_cameras");
  EXPECT_EQ(name(judge(true, true, false, false, false, true)), "degraded");
  EXPECT_EQ(name(judge(true, true, true, false, false, true)), "degraded");
  EXPECT_EQ(reason(judge(true, true, true, true, true, true)), "the network refused messages");
  EXPECT_EQ(name(judge(true, true, true, true, false, true)), "streaming");
  EXPECT_EQ(name(judge(true, true, true, true, false, false)), "uncalibrated");
  const Activity moved{true, true, true, true, false, CalibrationFit::kMisaligned};
  EXPECT_EQ(judge_state(moved, true), (ServiceCondition{ServiceState::kDegraded, StateCause::kMisaligned}));
}

}  // namespace
}  // namespace stereod
