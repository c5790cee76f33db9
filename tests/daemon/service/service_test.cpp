// The daemon in this process: what it tells systemd, and what a reload changes.
#include "daemon/service/service.h"

#include <gmock/gmock.h>

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <vector>

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

/// What the service publishes, by channel. The network can be made to block for rows.
struct Air {
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

class AirBus final : public MessageBus {
 public:
  explicit AirBus(Air& air) : air_(air) {}
  bool publish(const char* channel, const void* data, std::size_t size) noexcept override {
    std::unique_lock lock(air_.mutex);
    if (std::strstr(channel, "_DISPARITY") != nullptr) {
      air_.changed.wait(lock, [this] { return !air_.blocked; });
      if (air_.keep) decode(data, size, air_.rows[channel].emplace_back());
    } else if (std::strstr(channel, "_FRAME") != nullptr) {
      ++air_.frames;
      if (air_.keep) decode(data, size, air_.frame_messages.emplace_back());
      air_.changed.notify_all();
    } else if (std::strstr(channel, "_STATUS") != nullptr && air_.keep) {
      decode(data, size, air_.statuses.emplace_back());
    }
    return true;
  }

 private:
  template <typename Message>
  static void decode(const void* data, std::size_t size, Message& message) {
    EXPECT_EQ(message.decode(data, 0, static_cast<int>(size)), static_cast<int>(size));
  }
  Air& air_;
};

class ServiceTest : public testing::Test {
 protected:
  // As the daemon does, so that the logger is not first made by whichever thread has something to say.
  void SetUp() override { set_up_log("info"); }
  void write(const std::string& text) { std::ofstream(file_) << text; }
  std::unique_ptr<Service> start(const std::string& text) {
    write(text);
    return std::make_unique<Service>(read_config(file_), file_, [this](const std::string& url) {
      if (url == "udpm://239.255.76.67:7667?ttl=9") throw std::runtime_error("no such network");
      air_.opened.push_back(url);
      return std::make_unique<AirBus>(air_);
    });
  }
  std::string latest_reason() {
    const std::lock_guard lock(air_.mutex);
    return air_.statuses.empty() ? "" : air_.statuses.back().reason;
  }

  TemporaryDirectory directory_;
  const std::filesystem::path file_ = directory_ / "stereod.yaml";
  Air air_;
};

TEST_F(ServiceTest, IsReadyWhenTheFirstPairIsPublishedAndNotBefore) {
  NotifySocket systemd(directory_.path());
  air_.block(true);
  const auto service = start(kSynthetic);
  const auto tick = [&] { service->tick(); };
  ASSERT_TRUE(systemd.wait_for("STATUS=", std::chrono::seconds(60), tick));
  systemd.receive(std::chrono::milliseconds(500), tick);
  EXPECT_THAT(systemd.changes(), IsEmpty()) << "nothing was published yet";
  EXPECT_EQ(systemd.latest("STATUS="), "STATUS=Starting: waiting for the first frames.");
  air_.block(false);
  ASSERT_TRUE(systemd.wait_for("READY=1", std::chrono::seconds(60), tick));
  ASSERT_TRUE(systemd.wait_for("STATUS=Streaming: ", std::chrono::seconds(60), tick));
  EXPECT_THAT(systemd.latest("STATUS="), HasSubstr(" frames a second, "));
  service->stop();
  systemd.receive(std::chrono::milliseconds(100));
  EXPECT_THAT(systemd.changes(), ElementsAre("READY=1", "STOPPING=1"));
  EXPECT_EQ(systemd.count("WATCHDOG=1"), 0) << "nobody asked for it";
}

TEST_F(ServiceTest, WaitingForCamerasIsReadyAndAlive) {
  NotifySocket systemd(directory_.path(), std::chrono::seconds(10));
  const auto service = start(kMissingCameras);
  const auto tick = [&] { service->tick(); };
  ASSERT_TRUE(systemd.wait_for("READY=1", std::chrono::seconds(60), tick));
  EXPECT_THAT(systemd.latest("STATUS="),
              StartsWith("STATUS=Waiting for cameras: no frames from either camera; "
                         "no camera with the serial number NOT-L"));
  systemd.forget();
  EXPECT_TRUE(systemd.wait_for("WATCHDOG=1", std::chrono::seconds(60), tick));
  EXPECT_TRUE(systemd.wait_for("WATCHDOG=1", std::chrono::seconds(60), tick));
}

// The network does not take what it is given, so the publisher does not come back; the daemon's own thread
// goes on ticking all the while.
TEST_F(ServiceTest, AWedgedPipelineIsNotAlive) {
  NotifySocket systemd(directory_.path(), std::chrono::seconds(10));
  const auto service = start(kSynthetic);
  const auto tick = [&] { service->tick(); };
  ASSERT_TRUE(systemd.wait_for("WATCHDOG=1", std::chrono::seconds(60), tick)) << "while it streams";
  air_.block(true);
  systemd.receive(std::chrono::milliseconds(2500),
                  tick);  // the second in which it was wedged began with frames
  systemd.forget();
  systemd.receive(std::chrono::milliseconds(3000), tick);
  EXPECT_EQ(systemd.count("WATCHDOG=1"), 0);
  air_.block(false);
  EXPECT_TRUE(systemd.wait_for("WATCHDOG=1", std::chrono::seconds(60), tick)) << "it goes on";
}

TEST_F(ServiceTest, SaysNothingWhereNobodyListens) {
  const auto service = start(kSynthetic);
  air_.wait_for_more_frames(2);
  service->tick();
  service->reload();
  service->stop();
  EXPECT_FALSE(std::filesystem::exists(directory_ / "notify"));
}

/// Every frame the cameras gave was published, once, whole and in order.
void expect_no_frame_lost(Air& air) {
  const std::lock_guard lock(air.mutex);
  std::map<std::int64_t, int> rows;
  for (const auto& [channel, messages] : air.rows) {
    for (const disparity_rows_t& message : messages) rows[message.frame] += message.row_count;
  }
  for (std::size_t i = 0; i < air.frame_messages.size(); ++i) {
    const frame_t& frame = air.frame_messages[i];
    EXPECT_EQ(frame.frame, static_cast<std::int64_t>(i));
    EXPECT_EQ(frame.left_sequence, static_cast<int>(i));
    EXPECT_EQ(rows[frame.frame], frame.height) << "rows of frame " << i;
  }
}

TEST_F(ServiceTest, ReloadsWithoutLosingAFrameAndAllocatesNothingAfterwards) {
  const auto service = start(kSynthetic);
  air_.wait_for_more_frames(3);
  const std::vector<std::string> settings{
      "matcher: {preset: thesis, disparities: 24}\n", "matcher: {preset: robust, disparities: 40}\n",
      "lcm: {prefix: OTHER, rows_per_message: 5}\n", "lcm: {pacing: 0}\nlog: {level: warning}\n"};
  for (const std::string& setting : settings) {
    write(kSynthetic + setting);
    service->reload();
    air_.wait_for_more_frames(3);
  }
  {
    const std::lock_guard lock(air_.mutex);
    EXPECT_EQ(air_.rows["OTHER_DISPARITY"].front().row_count, 5);
    EXPECT_EQ(air_.rows["STEREO_DISPARITY"].back().disparities, 64)
        << "what is named no more has its default again";
    std::map<int, int> searched;
    for (const disparity_rows_t& rows : air_.rows["STEREO_DISPARITY"]) ++searched[rows.disparities];
    EXPECT_GT(searched[24], 0);
    EXPECT_GT(searched[40], 0);
    air_.keep = false;
  }
  if (AllocationCounter::supported()) {
    air_.wait_for_more_frames(2);
    const AllocationCounter counter;
    air_.wait_for_more_frames(20);
    EXPECT_EQ(counter.count(), 0u);
  }
  service->stop();
  expect_no_frame_lost(air_);
  EXPECT_THAT(air_.opened, ElementsAre("")) << "the same network all the while";
}

TEST_F(ServiceTest, AFileThatCannotWorkChangesNothingAndIsSaid) {
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
  for (const auto& [setting, complaint] : bad) {
    write(kSynthetic + setting);
    service->reload();
    air_.wait_for_more_frames(2);
    ASSERT_TRUE(systemd.wait_for("STATUS=Streaming: ", std::chrono::seconds(60), tick));
    ASSERT_TRUE(systemd.wait_for("STATUS=Streaming: ", std::chrono::seconds(60), tick));
    EXPECT_THAT(systemd.latest("STATUS="), HasSubstr("; the configuration was not taken over: "));
    EXPECT_THAT(systemd.latest("STATUS="), HasSubstr(complaint));
    EXPECT_THAT(latest_reason(), HasSubstr(complaint));
  }
  write(kSynthetic);
  service->reload();
  ASSERT_TRUE(systemd.wait_for("STATUS=Streaming: ", std::chrono::seconds(60), tick));
  ASSERT_TRUE(systemd.wait_for("STATUS=Streaming: ", std::chrono::seconds(60), tick));
  EXPECT_EQ(latest_reason(), "");
  service->stop();
  expect_no_frame_lost(air_);
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

TEST_F(ServiceTest, OtherCamerasAreSetUpAndTheNumbersGoOn) {
  const auto service = start(kSynthetic);
  air_.wait_for_more_frames(3);
  write("cameras: {source: synthetic, fps: 0, synthetic: {width: 96, height: 64}}\nworkers: 2\n");
  service->reload();
  air_.wait_for_more_frames(3);
  service->tick();
  service->stop();
  const std::lock_guard lock(air_.mutex);
  int small = 0;
  for (std::size_t i = 0; i < air_.frame_messages.size(); ++i) {
    EXPECT_EQ(air_.frame_messages[i].frame, static_cast<std::int64_t>(i));
    if (air_.frame_messages[i].width == 96) ++small;
  }
  EXPECT_GE(small, 3);
  EXPECT_EQ(air_.frame_messages.back().left_sequence, small - 1) << "the new cameras count from 0";
}

TEST_F(ServiceTest, CountsGoOnWhenCamerasAreSetUpAnew) {
  NotifySocket systemd(directory_.path());
  const auto service = start(kSynthetic);
  air_.wait_for_more_frames(10);
  write("cameras: {source: synthetic, fps: 50, synthetic: {width: 96, height: 64}}\n");
  service->reload();
  air_.wait_for_more_frames(1);
  ASSERT_TRUE(systemd.wait_for("STATUS=Streaming", std::chrono::seconds(60), [&] { service->tick(); }));
  service->stop();
  const std::lock_guard lock(air_.mutex);
  const status_t& status = air_.statuses.back();
  EXPECT_GE(status.left.frames, 11);
  EXPECT_GE(status.pairs_made, 11);
  EXPECT_GE(status.frames_published, 11);
}

TEST_F(ServiceTest, AnotherNetworkIsOpenedAndUsed) {
  const auto service = start(kSynthetic);
  air_.wait_for_more_frames(2);
  write(std::string(kSynthetic) + "lcm: {url: 'udpm://239.255.76.67:7668?ttl=0'}\n");
  service->reload();
  air_.wait_for_more_frames(2);
  service->stop();
  EXPECT_THAT(air_.opened, ElementsAre("", "udpm://239.255.76.67:7668?ttl=0"));
  expect_no_frame_lost(air_);
}

TEST_F(ServiceTest, ACalibrationThatHasChangedIsReadAgain) {
  write_recorded_pairs(directory_.path(), {160, 120}, 1);
  const auto service = start(kSynthetic);
  air_.wait_for_more_frames(2);
  write(std::string(kSynthetic) + "calibration: calibration.yaml\n");
  service->reload();
  air_.wait_for_more_frames(2);
  write_recorded_pairs(directory_.path(), {96, 64}, 1);
  service->reload();
  while (latest_reason().empty()) service->tick();
  EXPECT_THAT(latest_reason(), HasSubstr("the calibration is for images of 96×64, the cameras give 160×120"));
  service->stop();
  expect_no_frame_lost(air_);
}

}  // namespace
}  // namespace stereod
