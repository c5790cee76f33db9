// SPDX-License-Identifier: BSD-3-Clause
// One frame through every program: stereod, stereo-tap, a recording, stereod again, a program with the client library,
// stereo-view.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/client/stereod_client.h"
#include "tests/support/log_frames.h"
#include "tests/support/network.h"
#include "tests/support/recorded_pairs.h"
#include "tests/support/run_program.h"
#include "tests/support/snapshot.h"
#include "tests/support/temporary_directory.h"

namespace stereod::tools {
namespace {

using testing::HasSubstr;

constexpr Size kSize{320, 240};
constexpr const char* kUrl = "udpm://239.255.76.67:17673?ttl=0";  // a port of the test's own
const std::filesystem::path kBin = STEREOD_BIN_DIR;

class Chain : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
    write_recorded_pairs(directory_.path(), kSize, 1);  // for its calibration
  }

  /// Starts stereod; @p more is appended to its lcm section.
  ChildProgram start_stereod(const std::string& prefix, const std::string& cameras, const std::string& more) {
    const std::filesystem::path config = directory_ / (prefix + ".yaml");
    std::ofstream(config) << "cameras: {" << cameras << "}\ncalibration: calibration.yaml\n"
                          << "publish: {region: {left: 20, top: 30, width: 280, height: 180}}\n"
                          << "lcm: {url: \"" << kUrl << "\", prefix: " << prefix << more << "}\n";
    return {kBin / "stereod", {"--config", config.string()}, directory_.path()};
  }

  ProgramRun tap(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--lcm-url", kUrl, "--prefix", "FIELD"});
    return run_program(kBin / "stereo-tap", arguments, directory_.path());
  }

  TemporaryDirectory directory_;
};

/// Returns the port that stereo-view prints; 0 if it prints none within a minute.
int port_of(const ChildProgram& view) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < deadline) {
    const std::string text = view.out_so_far();
    const std::string start = "http://127.0.0.1:";
    if (text.find('\n') != std::string::npos && text.rfind(start, 0) == 0) {
      return std::stoi(text.substr(start.size()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return 0;
}

void expect_same(const StereoFrame& a, const StereoFrame& b) {
  ASSERT_EQ(a.disparity.width(), b.disparity.width());
  ASSERT_EQ(a.disparity.height(), b.disparity.height());
  EXPECT_EQ(a.grid, b.grid);
  for (int y = 0; y < a.disparity.height(); ++y) {
    for (int x = 0; x < a.disparity.width(); ++x) ASSERT_EQ(a.disparity.at(x, y), b.disparity.at(x, y));
  }
}

TEST_F(Chain, Frame_SameAfterEveryProgram) {
  const std::filesystem::path log = directory_ / "field.lcm";
  {
    ChildProgram field =
        start_stereod("FIELD", "source: synthetic, fps: 10, synthetic: {width: 320, height: 240}",
                      ", raw_images: true, raw_images_per_second: 60");
    ProgramRun check = tap({"check", "--seconds", "3"});
    for (int i = 0; i < 10 && check.status == 2; ++i)
      check = tap({"check", "--seconds", "3"});  // no frame yet
    EXPECT_EQ(check.status, 0) << check.out << check.err;
    const ProgramRun recording = tap({"record", log.string(), "--seconds", "4"});
    ASSERT_EQ(recording.status, 0) << recording.err;
    EXPECT_THAT(recording.out, HasSubstr("FIELD_DISPARITY"));
    field.send(SIGTERM);
    EXPECT_EQ(field.wait().status, 0);
  }
  const std::map<std::int64_t, StereoFrame> recorded = frames_of(log, "FIELD");
  ASSERT_GT(recorded.size(), 5U);

  // The played recording equals the recorded frames.
  std::map<std::int64_t, StereoFrame> played, rematched;
  const auto listener = [](const char* prefix, std::map<std::int64_t, StereoFrame>& frames) {
    StereoClient::Options options;
    options.url = kUrl;
    options.prefix = prefix;
    options.latest_only = false;
    options.queue_messages = 100'000;
    auto client = std::make_unique<StereoClient>(options);
    client->on_frame([&frames](StereoFrame&& frame) {
      if (frame.complete()) frames.emplace(frame.utime, std::move(frame));
    });
    return client;
  };
  {
    const auto client = listener("FIELD", played);
    const ProgramRun play = tap({"play", log.string()});
    EXPECT_EQ(play.status, 0) << play.err;
    while (client->handle(200)) {
    }
  }
  EXPECT_GE(played.size(), recorded.size() - 1);
  for (const auto& [utime, frame] : played) {
    ASSERT_EQ(recorded.count(utime), 1U);
    expect_same(frame, recorded.at(utime));
  }

  // Matched again from its raw images, and shown on the page.
  ChildProgram view(kBin / "stereo-view", {"--lcm-url", kUrl, "--prefix", "DESK", "--port", "0"},
                    directory_.path());
  const int port = port_of(view);
  ASSERT_GT(port, 0);
  httplib::Client web("127.0.0.1", port);
  const auto client = listener("DESK", rematched);
  std::map<std::int64_t, DecodedSnapshot> shown;
  {
    ChildProgram stereod = start_stereod(
        "DESK", "source: log, fps: 10, log: {file: field.lcm, prefix: FIELD}", ", left_image: jpeg");
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    std::int64_t after = 0;
    while (shown.size() < 5 && std::chrono::steady_clock::now() < deadline) {
      const auto answer = web.Get("/snapshot?after=" + std::to_string(after) + "&step=1");
      while (client->handle(1)) {
      }
      if (!answer || answer->status != 200) continue;
      const DecodedSnapshot snapshot = decode_snapshot(answer->body);
      after = snapshot.json["number"].as<std::int64_t>();
      if (snapshot.json["frame"] && snapshot.json["frame"]["complete"].as<bool>()) {
        shown.emplace(snapshot.json["frame"]["utime"].as<std::int64_t>(), snapshot);
      }
    }
    EXPECT_EQ(stereod.wait().status, 0) << "it ends with the recording";
  }
  while (client->handle(200)) {
  }
  ASSERT_GE(rematched.size(), 5U);
  int compared = 0;
  for (const auto& [utime, frame] : rematched) {
    const auto original = recorded.find(utime);
    if (original == recorded.end()) continue;  // only its raw images were recorded
    expect_same(frame, original->second);
    ++compared;
  }
  EXPECT_GE(compared, static_cast<int>(rematched.size()) - 2);
  ASSERT_GE(shown.size(), 5U);
  for (const auto& [utime, snapshot] : shown) {
    ASSERT_EQ(rematched.count(utime), 1U);
    const StereoFrame& frame = rematched.at(utime);
    const YAML::Node json = snapshot.json["frame"];
    EXPECT_EQ(json["left"].as<int>(), 20);
    EXPECT_EQ(json["top"].as<int>(), 30);
    EXPECT_EQ(json["decimation_x"].as<int>(), 1);
    ASSERT_EQ(snapshot.disparity.size(), std::size_t{280 * 180});
    for (int y = 0; y < 180; ++y) {
      for (int x = 0; x < 280; ++x) {
        ASSERT_EQ(snapshot.disparity[static_cast<std::size_t>(y * 280 + x)], frame.disparity.at(x, y));
      }
    }
  }
  EXPECT_GT(shown.rbegin()->second.left.size(), 1000U) << "with the left image";
}

}  // namespace
}  // namespace stereod::tools
