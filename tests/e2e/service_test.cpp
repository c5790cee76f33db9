// SPDX-License-Identifier: BSD-3-Clause
// The daemon as systemd runs it: notifications on NOTIFY_SOCKET, and SIGHUP. It publishes to an LCM log, so
// that no message is lost on the way.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <lcm/lcm.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/lcm/message_decoder.h"
#include "stereod/disparity_rows_t.hpp"
#include "stereod/frame_t.hpp"
#include "stereod/status_t.hpp"
#include "tests/support/notify_socket.h"
#include "tests/support/recorded_pairs.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::filesystem::path kBin = STEREOD_BIN_DIR;

/// Everything that was published.
struct Published {
  std::vector<frame_t> frames;
  std::map<std::string, std::vector<disparity_rows_t>> rows;  // by channel
  std::vector<status_t> statuses;
};

template <typename Message>
Message decoded(const lcm_eventlog_event_t& event) {
  Message message{};
  EXPECT_TRUE(decode_message(event.data, static_cast<std::size_t>(event.datalen), message));
  return message;
}

Published read_log(const std::filesystem::path& file) {
  Published published;
  const std::unique_ptr<lcm_eventlog_t, decltype(&lcm_eventlog_destroy)> log(
      lcm_eventlog_create(file.c_str(), "r"), lcm_eventlog_destroy);
  if (!log) return published;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log.get())) {
    const std::string channel(event->channel, static_cast<std::size_t>(event->channellen));
    if (channel.ends_with("_FRAME")) published.frames.push_back(decoded<frame_t>(*event));
    if (channel.ends_with("_DISPARITY")) published.rows[channel].push_back(decoded<disparity_rows_t>(*event));
    if (channel.ends_with("_STATUS")) published.statuses.push_back(decoded<status_t>(*event));
    lcm_eventlog_free_event(event);
  }
  return published;
}

class ServiceE2e : public testing::Test {
 protected:
  ServiceE2e() { write_recorded_pairs(directory_.path(), {160, 120}, 4); }

  void write(const std::string& cameras, const std::string& lcm, const std::string& more) {
    std::ofstream(file_) << "cameras: {source: replay, " << cameras << "}\nlcm: {url: 'file://"
                         << log_.string() << "?mode=w'" << lcm << "}\n"
                         << more;
  }
  std::unique_ptr<ChildProgram> start() {
    return std::make_unique<ChildProgram>(
        kBin / "stereod", std::vector<std::string>{"--config", file_.string()}, directory_.path());
  }

  TemporaryDirectory directory_;
  NotifySocket systemd_{directory_.path(), std::chrono::seconds(10)};
  const std::filesystem::path file_ = directory_ / "stereod.yaml";
  const std::filesystem::path log_ = directory_ / "published.lcm";
  static constexpr const char* kDirectory = "fps: 0, replay: {directory: .}";
};

TEST_F(ServiceE2e, Sighup_NoFrameLost) {
  write(kDirectory, "", "matcher: {preset: thesis, disparities: 24}\n");
  const auto stereod = start();
  ASSERT_TRUE(systemd_.wait_for("READY=1")) << stereod->err_so_far();
  const auto reload = [&] {
    systemd_.receive(std::chrono::milliseconds(200));
    stereod->send(SIGHUP);
    EXPECT_TRUE(systemd_.wait_for("RELOADING=1"));
    EXPECT_TRUE(systemd_.wait_for("READY=1"));
  };
  write(kDirectory, "", "matcher: {preset: robust, disparities: 40}\ncalibration: calibration.yaml\n");
  reload();
  write(kDirectory, ", prefix: OTHER, rows_per_message: 5, pacing: 0", "workers: 3\n");
  reload();
  write(kDirectory, ", prefix: OTHER, pacing: 0.1", "matcher: {windw: 3}\n");
  reload();
  write(kDirectory, ", prefix: OTHER, pacing: 0.1", "log: {level: error}\n");
  reload();
  reload();  // the level is error, so this one is not logged
  stereod->send(SIGTERM);
  const ProgramRun run = stereod->wait();
  systemd_.receive(std::chrono::milliseconds(50));
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(systemd_.changes(),
              ElementsAre("READY=1", "RELOADING=1", "READY=1", "RELOADING=1", "READY=1", "RELOADING=1",
                          "READY=1", "RELOADING=1", "READY=1", "RELOADING=1", "READY=1", "STOPPING=1"));

  const Published published = read_log(log_);
  std::map<std::int64_t, int> rows;
  std::map<int, int> searched;
  for (const auto& [channel, messages] : published.rows) {
    for (const disparity_rows_t& message : messages) {
      rows[message.frame] += message.row_count;
      ++searched[message.disparities];
    }
  }
  for (std::size_t i = 0; i < published.frames.size(); ++i) {
    ASSERT_EQ(published.frames[i].frame, static_cast<std::int64_t>(i));
    ASSERT_EQ(published.frames[i].left_sequence, static_cast<int>(i)) << "a frame of the camera was lost";
    ASSERT_EQ(rows[published.frames[i].frame], 120) << "rows of frame " << i;
  }
  EXPECT_GT(searched[24], 0);
  EXPECT_GT(searched[40], 0);
  EXPECT_GT(searched[64], 0);
  EXPECT_EQ(published.rows.at("OTHER_DISPARITY").front().row_count, 5);
  EXPECT_GT(published.rows.at("OTHER_DISPARITY").back().row_count, 5) << "the default again";

  const std::size_t problem =
      run.err.find(" error: reload failed, keeping the previous configuration: " + file_.string() +
                   ":3: matcher.windw: is not a known key");
  EXPECT_NE(problem, std::string::npos) << run.err;
  const auto reloads = [&](std::size_t from) {
    int count = 0;
    for (std::size_t at = from; (at = run.err.find("configuration reloaded", at)) != run.err.npos; ++at) {
      ++count;
    }
    return count;
  };
  EXPECT_EQ(reloads(0), 2) << "at level error, reloads are not logged\n" << run.err;
}

TEST_F(ServiceE2e, Sighup_CamerasRestartedOnlyIfChanged) {
  write(kDirectory, "", "");
  const auto stereod = start();
  ASSERT_TRUE(systemd_.wait_for("READY=1")) << stereod->err_so_far();
  write("fps: 30, replay: {left: left_00.png, right: right_00.png}", "", "");
  stereod->send(SIGHUP);
  EXPECT_TRUE(systemd_.wait_for("RELOADING=1"));
  EXPECT_TRUE(systemd_.wait_for("READY=1"));
  EXPECT_TRUE(systemd_.wait_for("STATUS=uncalibrated: "));
  write("fps: 30, replay: {left: left_00.png, right: gone.png}", "", "");
  stereod->send(SIGHUP);
  EXPECT_TRUE(systemd_.wait_for("RELOADING=1"));
  EXPECT_TRUE(systemd_.wait_for("STATUS=uncalibrated: "));
  EXPECT_TRUE(systemd_.wait_for("STATUS=uncalibrated: "));
  EXPECT_THAT(systemd_.latest("STATUS="), HasSubstr("reload failed, keeping the previous configuration: "));
  EXPECT_THAT(systemd_.latest("STATUS="), HasSubstr("gone.png"));
  stereod->send(SIGTERM);
  const ProgramRun run = stereod->wait();
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.err, HasSubstr("configuration reloaded, cameras restarted: "));
  const Published published = read_log(log_);
  std::size_t began_again = 0;
  for (std::size_t i = 1; i < published.frames.size(); ++i) {
    ASSERT_EQ(published.frames[i].frame, static_cast<std::int64_t>(i)) << "frame numbers continue";
    if (published.frames[i].left_sequence < published.frames[i - 1].left_sequence) ++began_again;
  }
  EXPECT_EQ(began_again, 1u) << "the failed reload did not restart the cameras";
  EXPECT_THAT(published.statuses.back().reason, HasSubstr("gone.png"));
}

// The log is a pipe that is not read: the publisher blocks, as on a disk that hangs.
TEST_F(ServiceE2e, Stalled_NotAliveUntilRecovered) {
  ASSERT_EQ(::mkfifo(log_.c_str(), 0600), 0);
  const int pipe = ::open(log_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(pipe, 0);
  std::vector<char> bytes(1 << 16);
  const auto empty_the_pipe = [&] {
    while (::read(pipe, bytes.data(), bytes.size()) > 0) {
    }
  };
  write("fps: 30, replay: {directory: .}", "", "");
  const auto stereod = start();
  EXPECT_TRUE(systemd_.wait_for("WATCHDOG=1", std::chrono::seconds(60), empty_the_pipe))
      << stereod->err_so_far();
  systemd_.receive(std::chrono::milliseconds(2500));
  systemd_.forget();
  systemd_.receive(std::chrono::milliseconds(3000));
  EXPECT_EQ(systemd_.count("WATCHDOG=1"), 0);
  EXPECT_TRUE(systemd_.wait_for("WATCHDOG=1", std::chrono::seconds(60), empty_the_pipe));
  stereod->send(SIGTERM);
  EXPECT_TRUE(systemd_.wait_for("STOPPING=1", std::chrono::seconds(60), empty_the_pipe));
  ::close(pipe);
  EXPECT_EQ(stereod->wait().status, 0);
}

}  // namespace
}  // namespace stereod
