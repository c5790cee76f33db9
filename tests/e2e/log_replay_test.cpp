// SPDX-License-Identifier: BSD-3-Clause
// A problem in the field, reproduced in the lab: stereod, recorded by stereo-tap, replayed by stereod.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <map>
#include <string>

#include "daemon/client/stereod_client.h"
#include "tests/support/log_frames.h"
#include "tests/support/network.h"
#include "tests/support/recorded_pairs.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

using testing::HasSubstr;

constexpr Size kSize{320, 240};
constexpr const char* kUrl = "udpm://239.255.76.67:17667?ttl=0";  // a port for tests only
const std::filesystem::path kBin = STEREOD_BIN_DIR;

class LogReplay : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
    write_recorded_pairs(directory_.path(), kSize, 1);  // for its calibration
    const std::filesystem::path field = directory_ / "field.yaml";
    std::ofstream(field)
        << "cameras: {source: synthetic, fps: 10, synthetic: {width: 320, height: 240, skew_ms: 2}}\n"
        << "calibration: calibration.yaml\n"
        << "lcm: {url: \"" << kUrl << "\", prefix: FIELD, raw_images: true, "
        << "raw_images_per_second: 60}\n";
    ChildProgram stereod(kBin / "stereod", {"--config", field.string()}, directory_.path());
    // Recording starts when frames are published, even on a slow machine.
    const ProgramRun first = run_program(kBin / "stereo-tap",
                                         {"save", "--frames", "1", "--timeout", "60", "--out",
                                          directory_.path().string(), "--lcm-url", kUrl, "--prefix", "FIELD"},
                                         directory_.path());
    ASSERT_NE(first.status, 2) << first.err;  // status 2: nothing arrived; the first frame may be incomplete
    recording_ =
        run_program(kBin / "stereo-tap",
                    {"record", log_.string(), "--seconds", "3", "--lcm-url", kUrl, "--prefix", "FIELD"},
                    directory_.path());
  }

  TemporaryDirectory directory_;
  const std::filesystem::path log_ = directory_ / "field.lcm";
  ProgramRun recording_;
};

TEST_F(LogReplay, RecordedByTap_SameDisparities) {
  ASSERT_EQ(recording_.status, 0) << recording_.err;
  EXPECT_THAT(recording_.out, HasSubstr("FIELD_LEFT_RAW"));
  EXPECT_THAT(recording_.out, HasSubstr("FIELD_DISPARITY"));
  const std::map<std::int64_t, StereoFrame> field = frames_of(log_, "FIELD");
  ASSERT_GT(field.size(), 5U);

  const std::filesystem::path lab = directory_ / "lab.yaml", lab_log = directory_ / "lab.lcm";
  std::ofstream(lab) << "cameras: {source: log, fps: 0, log: {file: field.lcm, prefix: FIELD}}\n"
                     << "calibration: calibration.yaml\n"
                     << "lcm: {url: \"file://" << lab_log.string() << "?mode=w\", prefix: LAB}\n";
  const ProgramRun run = run_program(kBin / "stereod", {"--config", lab.string()}, directory_.path());
  EXPECT_EQ(run.status, 0) << run.err;
  const std::map<std::int64_t, StereoFrame> replayed = frames_of(lab_log, "LAB");
  ASSERT_GT(replayed.size(), 5U);
  int compared = 0;
  for (const auto& [utime, frame] : replayed) {
    const auto original = field.find(utime);
    if (original == field.end()) continue;  // only the raw images of this frame were recorded
    ++compared;
    EXPECT_EQ(frame.summary->skew_us, original->second.summary->skew_us);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        ASSERT_EQ(frame.disparity.at(x, y), original->second.disparity.at(x, y))
            << utime << ": " << x << ", " << y;
      }
    }
  }
  EXPECT_GE(compared, static_cast<int>(replayed.size()) - 2);
}

TEST_F(LogReplay, StereoTap_ListsAndPlays) {
  const auto tap = [&](const std::vector<std::string>& arguments) {
    return run_program(kBin / "stereo-tap", arguments, directory_.path());
  };
  const ProgramRun list = tap({"play", log_.string(), "--list"});
  EXPECT_EQ(list.status, 0) << list.err;
  EXPECT_EQ(list.out, recording_.out);  // the same table
  StereoClient::Options options;
  options.url = kUrl;
  options.prefix = "FIELD";
  StereoClient client(options);
  int frames = 0;
  client.on_frame([&](StereoFrame&& frame) { frames += frame.complete() ? 1 : 0; });
  ChildProgram play(kBin / "stereo-tap", {"play", log_.string(), "--speed", "3", "--lcm-url", kUrl},
                    directory_.path());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (frames < 3 && std::chrono::steady_clock::now() < deadline) client.handle(100);
  EXPECT_GE(frames, 3);
  EXPECT_EQ(play.wait().status, 0);

  // Moves the time of the first event by more than an hour: one byte behind the sync word and the number.
  std::fstream damaged(log_, std::ios::in | std::ios::out | std::ios::binary);
  constexpr int kMark = 4, kNumber = 8, kFourthByte = 3;
  damaged.seekg(kMark + kNumber + kFourthByte);
  const char byte = static_cast<char>(damaged.get() + 1);
  damaged.seekp(kMark + kNumber + kFourthByte);
  damaged.put(byte);
  damaged.close();
  const ProgramRun jump = tap({"play", log_.string(), "--speed", "3", "--lcm-url", kUrl});
  EXPECT_EQ(jump.status, 0) << jump.err;
  EXPECT_THAT(jump.err, HasSubstr("1 messages are more than 10 s before or after their predecessor"));

  std::ofstream(log_) << "no log";
  const ProgramRun bad = tap({"play", log_.string()});
  EXPECT_EQ(bad.status, 1);
  EXPECT_THAT(bad.err, HasSubstr("this is no LCM log"));
  EXPECT_EQ(tap({"record", "/no/such/directory/x.lcm"}).status, 1);
}

}  // namespace
}  // namespace stereod
