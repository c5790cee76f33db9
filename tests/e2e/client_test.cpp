// SPDX-License-Identifier: BSD-3-Clause
// The client library with a stereod in another process, and the examples that use it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/geometry/depth.h"
#include "daemon/client/stereod_client.h"
#include "daemon/config/calibration_file.h"
#include "daemon/lcm/bus.h"
#include "daemon/lcm/message_decoder.h"
#include "stereod/depth_rows_t.hpp"
#include "stereod/pointcloud_t.hpp"
#include "tests/support/network.h"
#include "tests/support/random_images.h"
#include "tests/support/recorded_pairs.h"
#include "tests/support/run_program.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

constexpr Size kSize{320, 240};
constexpr const char* kUrl = "udpm://239.255.76.67:17667?ttl=0";  // a port of the tests' own
const std::filesystem::path kBin = STEREOD_BIN_DIR;

class ClientE2e : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
    write_recorded_pairs(directory_.path(), kSize, 2);
    std::ofstream(config_) << "cameras: {source: replay, fps: 20, replay: {directory: .}}\n"
                           << "calibration: calibration.yaml\n"
                           << "lcm: {url: \"" << kUrl << "\", prefix: CLIENT}\n";
    options_.url = kUrl;
    options_.prefix = "CLIENT";
  }

  ChildProgram start_stereod() {
    return {kBin / "stereod", {"--config", config_.string()}, directory_.path()};
  }

  /// Handles messages until a condition holds. Returns false after a minute.
  static bool handle_until(StereoClient& client, const std::function<bool()>& is_so) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!is_so()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      client.handle(100);
    }
    return true;
  }

  TemporaryDirectory directory_;
  const std::filesystem::path config_ = directory_ / "stereod.yaml";
  StereoClient::Options options_;
};

TEST_F(ClientE2e, Stream_DepthAsCalibrated) {
  const Calibration calibration = read_calibration(directory_ / "calibration.yaml");
  StereoClient client(options_);
  int frames = 0, pixels = 0;
  client.on_frame([&](StereoFrame&& frame) {
    if (!frame.camera || !frame.complete()) return;
    ++frames;
    ASSERT_EQ(frame.disparity.width(), kSize.width);
    ASSERT_EQ(frame.disparity.height(), kSize.height);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const float px = frame.disparity_px(x, y);
        if (std::isnan(px)) continue;
        ++pixels;
        const double depth = depth_m(calibration, static_cast<double>(px));
        ASSERT_FLOAT_EQ(frame.depth_m(x, y), static_cast<float>(depth));
        const StereoPoint point = frame.point(x, y);
        if (std::isinf(depth)) {  // infinitely far: no point
          ASSERT_TRUE(std::isnan(point.x) && std::isnan(point.y) && std::isnan(point.z));
          continue;
        }
        const RectifiedProjection& p = calibration.left.projection;
        ASSERT_NEAR(static_cast<double>(point.x) * p.fx / depth + p.cx, x, 1e-3);
        ASSERT_NEAR(static_cast<double>(point.y) * p.fy / depth + p.cy, y, 1e-3);
      }
    }
  });
  ChildProgram stereod = start_stereod();
  EXPECT_TRUE(handle_until(client, [&] { return frames >= 5 || HasFailure(); }));
  EXPECT_GT(pixels, 5 * kSize.width * kSize.height / 3);
  EXPECT_EQ(client.counts().messages_ignored, 0);
  EXPECT_EQ(describe_problems(client.counts()), "");
}

/// Decodes the messages of a channel.
template <typename Message>
void listen(lcm_t* lcm, const char* channel, std::vector<Message>& received) {
  lcm_subscribe(
      lcm, channel,
      [](const lcm_recv_buf_t* in, const char*, void* to) {
        Message message{};
        const std::span bytes(static_cast<const std::byte*>(in->data), in->data_size);
        if (decode_message(bytes, message)) {
          static_cast<std::vector<Message>*>(to)->push_back(std::move(message));
        }
      },
      &received);
}

TEST_F(ClientE2e, DepthAndCloud_EqualDisparities) {
  std::ofstream(config_, std::ios::app)
      << "publish: {region: {left: 80, top: 60, width: 200, height: 120}, decimation_x: 2, depth: true, "
         "cloud: true, cloud_decimation: 4}\n";
  lcm_t* lcm = lcm_create((std::string(kUrl) + "&recv_buf_size=212992").c_str());
  ASSERT_NE(lcm, nullptr);
  std::vector<depth_rows_t> depths;
  std::vector<pointcloud_t> clouds;
  std::map<std::int64_t, StereoFrame> frames;
  {
    StereoClient client(lcm, "CLIENT");
    client.on_frame([&](StereoFrame&& frame) {
      if (frame.complete() && frame.camera) frames.emplace(frame.frame, std::move(frame));
    });
    listen(lcm, "CLIENT_DEPTH", depths);
    listen(lcm, "CLIENT_CLOUD", clouds);
    ChildProgram stereod = start_stereod();
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (frames.size() < 6 && std::chrono::steady_clock::now() < deadline) lcm_handle_timeout(lcm, 100);
    for (int i = 0; i < 50; ++i) lcm_handle_timeout(lcm, 10);  // the cloud of the last frame
  }
  lcm_destroy(lcm);
  ASSERT_GE(frames.size(), 6U);
  int rows = 0, pixels = 0, compared_clouds = 0;
  for (const depth_rows_t& m : depths) {
    const auto found = frames.find(m.frame);
    if (found == frames.end()) continue;
    ASSERT_EQ(m.width, 100);
    for (int v = m.first_row; v < m.first_row + m.row_count; ++v, ++rows) {
      for (int u = 0; u < m.width; ++u) {
        const auto at = static_cast<std::size_t>(2 * ((v - m.first_row) * m.width + u));
        const int mm = m.data[at] | m.data[at + 1] << 8;
        const float depth = found->second.depth_m(u, v);
        ASSERT_EQ(mm == 0, std::isnan(depth));
        if (mm > 0 && mm < 65535) {
          ASSERT_NEAR(mm, depth * 1000, 0.51 + 1e-4 * mm);
        }
        pixels += mm > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GE(rows, 5 * 120);
  EXPECT_GT(pixels, rows * 30);
  for (const pointcloud_t& cloud : clouds) {
    const auto found = frames.find(cloud.seq);
    if (found == frames.end()) continue;
    // Every fourth pixel of the region is every second published pixel.
    std::vector<StereoPoint> expected;
    for (int v = 0; v < 120; v += 4) {
      for (int u = 0; u < 100; u += 2) {
        const StereoPoint point = found->second.point(u, v);
        if (std::isfinite(point.z)) expected.push_back(point);
      }
    }
    ASSERT_EQ(cloud.points.size(), expected.size());
    float sum_sent = 0, sum_expected = 0;  // blocks of rows, and so the points, arrive in any order
    for (const auto& point : cloud.points) sum_sent += point[0] + point[1] + point[2];
    for (const StereoPoint& point : expected) sum_expected += point.x + point.y + point.z;
    EXPECT_NEAR(sum_sent, sum_expected, 1e-3F * std::abs(sum_expected));
    ++compared_clouds;
  }
  EXPECT_GE(compared_clouds, 5);
}

// The consumer needs 0.2 s for a frame; the stream has 20 frames a second.
TEST_F(ClientE2e, SlowConsumer_GetsNewestFrames) {
  StereoClient client(options_);
  std::vector<std::int64_t> numbers;
  client.on_frame([&](StereoFrame&& frame) {
    numbers.push_back(frame.frame);
    // Slower than the daemon in any build.
    std::this_thread::sleep_for(std::chrono::milliseconds(kSanitized ? 1000 : 200));
  });
  ChildProgram stereod = start_stereod();
  ASSERT_TRUE(handle_until(client, [&] { return numbers.size() >= 8; }));
  EXPECT_GT(client.frames_skipped(), 0);
  for (std::size_t i = 1; i < numbers.size(); ++i) EXPECT_GT(numbers[i], numbers[i - 1]);
  EXPECT_GE(numbers.back() - numbers.front(), 8);
}

TEST_F(ClientE2e, RubbishOnChannels_CountedAndSurvived) {
  LcmBus bus(kUrl);
  Random random(3);
  StereoClient client(options_);
  int frames = 0;
  client.on_frame([&](StereoFrame&& frame) { frames += frame.complete() ? 1 : 0; });
  ChildProgram stereod = start_stereod();
  const bool arrived = handle_until(client, [&] {
    std::vector<std::uint8_t> rubbish(static_cast<std::size_t>(random.between(0, 2000)));
    for (std::uint8_t& byte : rubbish) byte = static_cast<std::uint8_t>(random.between(0, 255));
    for (const char* channel : {"CLIENT_DISPARITY", "CLIENT_FRAME", "CLIENT_CAMERA_INFO"}) {
      bus.publish(channel, rubbish.data(), rubbish.size());
    }
    return frames >= 10;
  });
  EXPECT_TRUE(arrived);
  EXPECT_GT(client.counts().messages_ignored, 10);
  EXPECT_THAT(describe_problems(client.counts()), testing::HasSubstr("are not messages of this stereod"));
}

TEST_F(ClientE2e, TwoDaemons_Reported) {
  StereoClient client(options_);
  int frames = 0;
  client.on_frame([&](StereoFrame&&) { ++frames; });
  ChildProgram first = start_stereod();
  ASSERT_TRUE(handle_until(client, [&] { return frames >= 3; }));
  ASSERT_EQ(describe_problems(client.counts()), "");
  ChildProgram second = start_stereod();
  EXPECT_TRUE(handle_until(client, [&] { return !describe_problems(client.counts()).empty(); }));
  const int before = frames;
  EXPECT_TRUE(handle_until(client, [&] { return frames > before + 5; }));
}

TEST_F(ClientE2e, HandlerThrows_HandleThrows) {
  StereoClient client(options_);
  client.on_rows([](const RowBlock&) { throw std::runtime_error("enough"); });
  ChildProgram stereod = start_stereod();
  EXPECT_THROW(handle_until(client, [] { return false; }), std::runtime_error);
}

TEST_F(ClientE2e, Examples_Run) {
  ::setenv("LCM_DEFAULT_URL", kUrl, 1);
  ChildProgram stereod = start_stereod();
  const ProgramRun points = run_program(kBin / "example_nearest_point", {"3", "CLIENT"}, directory_.path());
  const ProgramRun rows = run_program(kBin / "example_first_rows", {"20", "CLIENT"}, directory_.path());
  ::unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(points.status, 0) << points.err;
  EXPECT_EQ(points.err, "");
  EXPECT_THAT(points.out,
              testing::ContainsRegex(
                  "^frame [0-9]+: nearest at x -?[0-9]\\.[0-9]+ y -?[0-9]\\.[0-9]+ z [0-9]\\.[0-9]+ m\n"));
  EXPECT_GE(std::count(points.out.begin(), points.out.end(), '\n'), 3);
  EXPECT_EQ(rows.status, 0) << rows.err;
  EXPECT_THAT(rows.out, testing::ContainsRegex("frame [0-9]+ rows 0 to 15: [0-9]+ of 5120 pixels"));
}

}  // namespace
}  // namespace stereod
