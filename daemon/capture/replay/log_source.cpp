// SPDX-License-Identifier: BSD-3-Clause
// Lending the images of a log at their pace.
#include "daemon/capture/replay/log_source.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/capture/frame_clock.h"
#include "daemon/capture/replay/log_pairs.h"

namespace stereod {
namespace {

/// State that the two sources share.
struct Replay {
  Replay(std::vector<LoggedPair> logged, const LogReplayOptions& replay_options)
      : pairs(std::move(logged)), options(replay_options), clock(0, {{}, {}}) {
    length_us = pairs.back().left.utime - pairs.front().left.utime;
    if (pairs.size() > 1) length_us += length_us / static_cast<std::int64_t>(pairs.size() - 1);
  }

  const std::vector<LoggedPair> pairs;
  const LogReplayOptions options;
  std::int64_t length_us = 0;  // of one round of a loop
  FrameClock clock;            // hands out frame numbers and skips none
  std::mutex mutex;
  std::condition_variable stopped_changed;
  std::optional<std::chrono::steady_clock::time_point> origin;  // when pair 0 was handed out
};

class LogSource final : public FrameSource, private BufferOwner {
 public:
  LogSource(std::shared_ptr<Replay> replay, int camera, LoggedImage LoggedPair::*side)
      : replay_(std::move(replay)), camera_(camera), side_(side) {}

  Size frame_size() const override { return replay_->pairs.front().left.image.size(); }

  FrameLease next(std::chrono::milliseconds timeout) noexcept override {
    if (state() == SourceState::kFinished) return {};
    if (!tick_) tick_ = replay_->clock.wait(camera_, timeout);
    if (!tick_) return {};
    const auto number = static_cast<std::size_t>(tick_->number);
    if (!replay_->options.loop && number >= replay_->pairs.size()) {
      state_ = SourceState::kFinished;
      replay_->clock.give_back(camera_);
      replay_->clock.stop(camera_);  // the other camera no longer waits for this one
      return {};
    }
    const LoggedPair& pair = replay_->pairs[number % replay_->pairs.size()];
    const LoggedImage& logged = pair.*side_;
    const auto rounds = static_cast<std::int64_t>(number / replay_->pairs.size());
    Frame frame;
    frame.luma = {logged.image.row(0), logged.image.size(), logged.image.view().stride(), 1};
    frame.utime = logged.utime + rounds * replay_->length_us;
    frame.sequence = static_cast<std::uint32_t>(number);
    frame.captured_ns = tick_->captured_ns + (logged.utime - pair.left.utime) * 1000;
    if (replay_->options.original_pace && !wait_until_due(frame, timeout)) return {};
    tick_.reset();
    state_ = SourceState::kStreaming;
    return {frame, *this, 0};
  }

  SourceState state() const noexcept override { return state_; }
  void stop() noexcept override {
    {
      const std::lock_guard lock(replay_->mutex);
      stopped_ = true;
    }
    replay_->stopped_changed.notify_all();
    replay_->clock.stop(camera_);
  }

 private:
  /// Blocks until the frame is due and sets its capture time to that. Returns false if it is not due within
  /// @p timeout.
  bool wait_until_due(Frame& frame, std::chrono::milliseconds timeout) noexcept {
    std::unique_lock lock(replay_->mutex);
    const auto now = std::chrono::steady_clock::now();
    if (!replay_->origin) replay_->origin = now;
    const auto due =
        *replay_->origin + std::chrono::microseconds(frame.utime - replay_->pairs.front().left.utime);
    const auto stopped = [this] { return stopped_; };
    replay_->stopped_changed.wait_until(lock, std::min(due, now + timeout), stopped);
    if (stopped_ || std::chrono::steady_clock::now() < due) return false;
    frame.captured_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(due.time_since_epoch()).count();
    return true;
  }

  void give_back(int /*buffer*/) noexcept override { replay_->clock.give_back(camera_); }

  std::shared_ptr<Replay> replay_;
  int camera_;
  LoggedImage LoggedPair::*side_;
  std::optional<FrameTick> tick_;  // taken from the clock, but not due yet
  bool stopped_ = false;           // guarded by the replay's mutex
  std::atomic<SourceState> state_{SourceState::kWaiting};
};

}  // namespace

LogSources open_log(const std::filesystem::path& file, const LogReplayOptions& options) {
  LoggedPairs log = read_logged_pairs(file, options.prefix);
  LogSources sources;
  sources.pairs = static_cast<int>(log.pairs.size());
  sources.unpaired = log.unpaired;
  const auto replay = std::make_shared<Replay>(std::move(log.pairs), options);
  sources.left = std::make_unique<LogSource>(replay, 0, &LoggedPair::left);
  sources.right = std::make_unique<LogSource>(replay, 1, &LoggedPair::right);
  return sources;
}

}  // namespace stereod
