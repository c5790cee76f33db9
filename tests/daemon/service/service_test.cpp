// SPDX-License-Identifier: BSD-3-Clause
// The daemon in this process: notifications to systemd, and reloads.
#include "daemon/service/service.h"

#include <gmock/gmock.h>

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <vector>

#include "daemon/lcm/message_decoder.h"
#include "daemon/service/log.h"
#include "stereod/frame_t.hpp"
#include "tests/support/allocation_counter.h"
#include "tests/support/foreign_isa.h"
#include "tests/support/notify_socket.h"
#include "tests/support/recorded_pairs.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr const char* kSynthetic =
    "cameras: {source: synthetic, fps: 0, synthetic: {width: 160, height: 120}}\n"
    "workers: 2\n";
constexpr const char* kMissingCameras =
    "cameras: {source: v4l2, v4l2: {left: 'serial:NOT-L', right: 'serial:NOT-R'}}\n";

/// What the service publishes. The network can be made to block rows.
struct Network {
  std::mutex mutex;
  std::condition_variable changed;
  bool blocked = false;
  bool keep = true;
  int frames = 0;
  std::vector<frame_t> frame_messages;
  std::map<std::string, std::vector<disparity_rows_t>> rows;
  std::vector<status_t> statuses;
  std::vector<std::string> opened;

  void wait_for_more_frames(int count) {
    std::unique_lock lock(mutex);
    const int enough = frames + count;
    changed.wait(lock, [&] { return frames >= enough; });
  }
  void block(bool on) {
    const std::lock_guard lock(mutex);
    blocked = on;
    changed.notify_all();
  }
};

class NetworkBus final : public MessageBus {
 public:
  explicit NetworkBus(Network& network) : network_(network) {}
  bool publish(const char* channel, const void* data, std::size_t size) noexcept override {
    std::unique_lock lock(network_.mutex);
    if (std::strstr(channel, "_DISPARITY") != nullptr) {
      network_.changed.wait(lock, [this] { return !network_.blocked; });
      if (network_.keep) decode(data, size, network_.rows[channel].emplace_back());
    } else if (std::strstr(channel, "_FRAME") != nullptr) {
      ++network_.frames;
      if (network_.keep) decode(data, size, network_.frame_messages.emplace_back());
      network_.changed.notify_all();
    } else if (std::strstr(channel, "_STATUS") != nullptr && network_.keep) {
      decode(data, size, network_.statuses.emplace_back());
    }
    return true;
  }

 private:
  template <typename Message>
  static void decode(const void* data, std::size_t size, Message& message) {
    EXPECT_TRUE(decode_message({static_cast<const std::byte*>(data), size}, message));
  }
  Network& network_;
};

class ServiceTest : public testing::Test {
 protected:
  // As in the daemon, so that no other thread creates the logger.
  void SetUp() override { set_up_log("info"); }
  void write(const std::string& text) { std::ofstream(file_) << text; }
  std::unique_ptr<Service> start(const std::string& text) {
    write(text);
    return std::make_unique<Service>(read_config(file_), file_, [this](const std::string& url) {
      if (url == "udpm://239.255.76.67:7667?ttl=9") throw std::runtime_error("no such network");
      network_.opened.push_back(url);
      return std::make_unique<NetworkBus>(network_);
    });
  }
  std::string latest_reason() {
    const std::lock_guard lock(network_.mutex);
    return network_.statuses.empty() ? "" : network_.statuses.back().reason;
  }

  TemporaryDirectory directory_;
  const std::filesystem::path file_ = directory_ / "stereod.yaml";
  Network network_;
};

TEST_F(ServiceTest, FirstFrame_Ready) {
  NotifySocket systemd(directory_.path());
  network_.block(true);
  const auto service = start(kSynthetic);
  const auto tick = [&] { service->tick(); };
  ASSERT_TRUE(systemd.wait_for("STATUS=", std::chrono::seconds(60), tick));
  systemd.receive(std::chrono::milliseconds(500), tick);
  EXPECT_THAT(systemd.changes(), IsEmpty()) << "before the first frame was published";
  EXPECT_EQ(systemd.latest("STATUS="), "STATUS=starting: waiting for the first frames");
  network_.block(false);
  ASSERT_TRUE(systemd.wait_for("READY=1", std::chrono::seconds(60), tick));
  ASSERT_TRUE(systemd.wait_for("STATUS=streaming: ", std::chrono::seconds(60), tick));
  EXPECT_THAT(systemd.latest("STATUS="), HasSubstr(" fps, latency "));
  service->stop();
  systemd.receive(std::chrono::milliseconds(100));
  EXPECT_THAT(systemd.changes(), ElementsAre("READY=1", "STOPPING=1"));
  EXPECT_EQ(systemd.count("WATCHDOG=1"), 0) << "no watchdog was requested";
}

TEST_F(ServiceTest, WaitingForCameras_ReadyAndAlive) {
  NotifySocket systemd(directory_.path(), std::chrono::seconds(10));
  const auto service = start(kMissingCameras);
  const auto tick = [&] { service->tick(); };
  ASSERT_TRUE(systemd.wait_for("READY=1", std::chrono::seconds(60), tick));
  EXPECT_THAT(systemd.latest("STATUS="),
              StartsWith("STATUS=waiting for cameras: no frames from either camera; "
                         "no camera with the serial number NOT-L"));
  systemd.forget();
  EXPECT_TRUE(systemd.wait_for("WATCHDOG=1", std::chrono::seconds(60), tick));
  EXPECT_TRUE(systemd.wait_for("WATCHDOG=1", std::chrono::seconds(60), tick));
}

// The network blocks, so the publisher thread does not return. The main thread keeps calling tick().
TEST_F(ServiceTest, StalledPipeline_NotAlive) {
  NotifySocket systemd(directory_.path(), std::chrono::seconds(10));
  const auto service = start(kSynthetic);
  const auto tick = [&] { service->tick(); };
  ASSERT_TRUE(systemd.wait_for("WATCHDOG=1", std::chrono::seconds(60), tick)) << "while it streams";
  network_.block(true);
  systemd.receive(std::chrono::milliseconds(2500),
                  tick);  // the second in which it stalled began with frames
  systemd.forget();
  systemd.receive(std::chrono::milliseconds(3000), tick);
  EXPECT_EQ(systemd.count("WATCHDOG=1"), 0);
  network_.block(false);
  EXPECT_TRUE(systemd.wait_for("WATCHDOG=1", std::chrono::seconds(60), tick)) << "it recovered";
}

TEST_F(ServiceTest, NoNotifySocket_Silent) {
  const auto service = start(kSynthetic);
  network_.wait_for_more_frames(2);
  service->tick();
  service->reload();
  service->stop();
  EXPECT_FALSE(std::filesystem::exists(directory_ / "notify"));
}

/// Expects that every frame of the cameras was published once, complete and in order.
void expect_no_frame_lost(Network& network) {
  const std::lock_guard lock(network.mutex);
  std::map<std::int64_t, int> rows;
  for (const auto& [channel, messages] : network.rows) {
    for (const disparity_rows_t& message : messages) rows[message.frame] += message.row_count;
  }
  for (std::size_t i = 0; i < network.frame_messages.size(); ++i) {
    const frame_t& frame = network.frame_messages[i];
    EXPECT_EQ(frame.frame, static_cast<std::int64_t>(i));
    EXPECT_EQ(frame.left_sequence, static_cast<int>(i));
    EXPECT_EQ(rows[frame.frame], frame.height) << "rows of frame " << i;
  }
}

TEST_F(ServiceTest, Reload_NoFrameLostNoAllocation) {
  const auto service = start(kSynthetic);
  network_.wait_for_more_frames(3);
  const std::vector<std::string> settings{
      "matcher: {preset: thesis, disparities: 24}\n", "matcher: {preset: robust, disparities: 40}\n",
      "lcm: {prefix: OTHER, rows_per_message: 5}\n", "lcm: {pacing: 0}\nlog: {level: warning}\n"};
  for (const std::string& setting : settings) {
    write(kSynthetic + setting);
    service->reload();
    network_.wait_for_more_frames(3);
  }
  {
    const std::lock_guard lock(network_.mutex);
    EXPECT_EQ(network_.rows["OTHER_DISPARITY"].front().row_count, 5);
    EXPECT_EQ(network_.rows["STEREO_DISPARITY"].back().disparities, 64)
        << "a removed setting has its default";
    std::map<int, int> searched;
    for (const disparity_rows_t& rows : network_.rows["STEREO_DISPARITY"]) ++searched[rows.disparities];
    EXPECT_GT(searched[24], 0);
    EXPECT_GT(searched[40], 0);
    network_.keep = false;
  }
  if (AllocationCounter::supported()) {
    network_.wait_for_more_frames(2);
    const AllocationCounter counter;
    network_.wait_for_more_frames(20);
    EXPECT_EQ(counter.count(), 0u);
  }
  service->stop();
  expect_no_frame_lost(network_);
  EXPECT_THAT(network_.opened, ElementsAre("")) << "the bus is kept";
}

TEST_F(ServiceTest, ReloadBadFile_KeepsConfiguration) {
  NotifySocket systemd(directory_.path());
  const auto service = start(kSynthetic);
  const auto tick = [&] { service->tick(); };
  ASSERT_TRUE(systemd.wait_for("READY=1", std::chrono::seconds(60), tick));
  const std::map<std::string, std::string> bad{
      {"matcher: {windw: 3}\n", "stereod.yaml:3: matcher.windw: is not a known key"},
      {"matcher: {isa: " + foreign_isa() + "}\n",
       "stereod.yaml:3: matcher.isa: isa " + foreign_isa() + " is not available on this CPU"},
      {"lcm: {rows_per_message: 999}\n", "stereod.yaml:3: lcm.rows_per_message: found 999"},
      {"calibration: gone.yaml\n", "gone.yaml"},
      {"lcm: {url: 'udpm://239.255.76.67:7667?ttl=9'}\n", "no such network"},
  };
  for (const auto& [setting, problem] : bad) {
    write(kSynthetic + setting);
    service->reload();
    network_.wait_for_more_frames(2);
    ASSERT_TRUE(systemd.wait_for("STATUS=streaming: ", std::chrono::seconds(60), tick));
    ASSERT_TRUE(systemd.wait_for("STATUS=streaming: ", std::chrono::seconds(60), tick));
    EXPECT_THAT(systemd.latest("STATUS="),
                HasSubstr("; reload failed, keeping the previous configuration: "));
    EXPECT_THAT(systemd.latest("STATUS="), HasSubstr(problem));
    EXPECT_THAT(latest_reason(), HasSubstr(problem));
  }
  write(kSynthetic);
  service->reload();
  ASSERT_TRUE(systemd.wait_for("STATUS=streaming: ", std::chrono::seconds(60), tick));
  ASSERT_TRUE(systemd.wait_for("STATUS=streaming: ", std::chrono::seconds(60), tick));
  EXPECT_EQ(latest_reason(), "");
  service->stop();
  expect_no_frame_lost(network_);
  std::vector<std::string> changes{"READY=1"};
  for (std::size_t i = 0; i <= bad.size(); ++i) {
    changes.emplace_back("RELOADING=1");
    changes.emplace_back("READY=1");
  }
  changes.emplace_back("STOPPING=1");
  systemd.receive(std::chrono::milliseconds(100));
  EXPECT_THAT(systemd.changes(), testing::ElementsAreArray(changes));
  EXPECT_THAT(systemd.latest("RELOADING=1"), HasSubstr("\nMONOTONIC_USEC="));
}

TEST_F(ServiceTest, ReloadOtherCameras_FrameNumbersContinue) {
  const auto service = start(kSynthetic);
  network_.wait_for_more_frames(3);
  write("cameras: {source: synthetic, fps: 0, synthetic: {width: 96, height: 64}}\nworkers: 2\n");
  service->reload();
  network_.wait_for_more_frames(3);
  service->tick();
  service->stop();
  const std::lock_guard lock(network_.mutex);
  int small = 0;
  for (std::size_t i = 0; i < network_.frame_messages.size(); ++i) {
    EXPECT_EQ(network_.frame_messages[i].frame, static_cast<std::int64_t>(i));
    if (network_.frame_messages[i].width == 96) ++small;
  }
  EXPECT_GE(small, 3);
  EXPECT_EQ(network_.frame_messages.back().left_sequence, small - 1) << "the new cameras count from 0";
}

TEST_F(ServiceTest, ReloadOtherCameras_CountsContinue) {
  NotifySocket systemd(directory_.path());
  const auto service = start(kSynthetic);
  network_.wait_for_more_frames(10);
  write("cameras: {source: synthetic, fps: 50, synthetic: {width: 96, height: 64}}\n");
  service->reload();
  network_.wait_for_more_frames(1);
  ASSERT_TRUE(systemd.wait_for("STATUS=streaming", std::chrono::seconds(60), [&] { service->tick(); }));
  service->stop();
  const std::lock_guard lock(network_.mutex);
  const status_t& status = network_.statuses.back();
  EXPECT_GE(status.left.frames, 11);
  EXPECT_GE(status.pairs_made, 11);
  EXPECT_GE(status.frames_published, 11);
}

TEST_F(ServiceTest, ReloadOtherUrl_BusOpened) {
  const auto service = start(kSynthetic);
  network_.wait_for_more_frames(2);
  write(std::string(kSynthetic) + "lcm: {url: 'udpm://239.255.76.67:7668?ttl=0'}\n");
  service->reload();
  network_.wait_for_more_frames(2);
  service->stop();
  EXPECT_THAT(network_.opened, ElementsAre("", "udpm://239.255.76.67:7668?ttl=0"));
  expect_no_frame_lost(network_);
}

TEST_F(ServiceTest, ReloadCalibration_ReadAgain) {
  write_recorded_pairs(directory_.path(), {160, 120}, 1);
  const auto service = start(kSynthetic);
  network_.wait_for_more_frames(2);
  write(std::string(kSynthetic) + "calibration: calibration.yaml\n");
  service->reload();
  network_.wait_for_more_frames(2);
  write_recorded_pairs(directory_.path(), {96, 64}, 1);
  service->reload();
  while (latest_reason().empty()) service->tick();
  EXPECT_THAT(latest_reason(), HasSubstr("the calibration is for images of 96×64, the cameras give 160×120"));
  service->stop();
  expect_no_frame_lost(network_);
}

}  // namespace
}  // namespace stereod
