// SPDX-License-Identifier: BSD-3-Clause
// Lending recorded images.
#include "daemon/capture/replay/replay_source.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "daemon/capture/frame_clock.h"
#include "daemon/capture/replay/recording.h"

namespace stereod {

namespace {

/// State that the two sources share.
struct Replay {
  Replay(Recording pairs, const ReplayOptions& replay_options)
      : recording(std::move(pairs)), options(replay_options), clock(options.fps, {{}, {}}) {}

  Recording recording;
  ReplayOptions options;
  FrameClock clock;
};

class ReplaySource final : public FrameSource, private BufferOwner {
 public:
  ReplaySource(std::shared_ptr<Replay> replay, int camera, GrayImage RecordedPair::*side)
      : replay_(std::move(replay)), camera_(camera), side_(side) {}

  Size frame_size() const override { return replay_->recording.frame_size(); }

  FrameLease next(std::chrono::milliseconds timeout) noexcept override {
    if (state() == SourceState::kFinished) return {};
    const std::optional<FrameTick> tick = replay_->clock.wait(camera_, timeout);
    if (!tick) return {};
    const std::vector<RecordedPair>& pairs = replay_->recording.pairs();
    const auto number = static_cast<std::size_t>(tick->number);
    if (!replay_->options.loop && number >= pairs.size()) {
      state_ = SourceState::kFinished;
      replay_->clock.give_back(camera_);
      replay_->clock.stop(camera_);  // the other camera no longer waits for this one
      return {};
    }
    state_ = SourceState::kStreaming;
    const GrayView image = (pairs[number % pairs.size()].*side_).view();
    Frame frame;
    frame.luma = {image.row(0), image.size(), image.stride(), 1};
    frame.captured_ns = tick->captured_ns;
    frame.sequence = static_cast<std::uint32_t>(tick->number);
    return {frame, *this, 0};
  }

  SourceState state() const noexcept override { return state_; }
  void stop() noexcept override { replay_->clock.stop(camera_); }

 private:
  void give_back(int /*buffer*/) noexcept override { replay_->clock.give_back(camera_); }

  std::shared_ptr<Replay> replay_;
  int camera_;
  GrayImage RecordedPair::*side_;
  std::atomic<SourceState> state_{SourceState::kWaiting};
};

ReplaySources make_sources(Recording recording, const ReplayOptions& options) {
  const auto replay = std::make_shared<Replay>(std::move(recording), options);
  return {std::make_unique<ReplaySource>(replay, 0, &RecordedPair::left),
          std::make_unique<ReplaySource>(replay, 1, &RecordedPair::right)};
}

}  // namespace

ReplaySources open_replay(const std::filesystem::path& left, const std::filesystem::path& right,
                          const ReplayOptions& options) {
  return make_sources(Recording(left, right), options);
}

ReplaySources open_replay(const std::filesystem::path& directory, const ReplayOptions& options) {
  return make_sources(Recording(directory), options);
}

}  // namespace stereod
