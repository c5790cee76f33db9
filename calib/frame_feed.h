// Pairs of live pictures.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "calib/pair_input.h"
#include "core/pairing.h"
#include "daemon/capture/rig.h"
#include "daemon/config/config.h"

namespace stereod {

/// Where a live session's pictures come from.
class FrameFeed {
 public:
  virtual ~FrameFeed() = default;
  /// The next pair; nothing within the time-out, or ever again if finished().
  virtual std::optional<PicturePair> next(std::chrono::milliseconds timeout) = 0;
  /// A recording has come to its end.
  virtual bool finished() const = 0;
};

/// The configuration's cameras, opened as the daemon opens them, paired as it pairs. Frames that come while a
/// pair is being looked at are dropped, newest wins; only sources with `fps: 0`, which wait for their
/// consumer, lose none.
class RigFeed final : public FrameFeed {
 public:
  /// Throws what open_rig() throws.
  explicit RigFeed(const Config& config);
  ~RigFeed() override;
  RigFeed(const RigFeed&) = delete;
  RigFeed& operator=(const RigFeed&) = delete;

  std::optional<PicturePair> next(std::chrono::milliseconds timeout) override;
  bool finished() const override;

 private:
  void read(FrameSource& source, Side side);

  Rig rig_;
  bool waits_;  // for a pair to be taken before the next frame
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Pairing<GreyImage> pairing_;
  bool stopping_ = false;
  int running_ = 2;
  std::uint64_t taken_ = 0;
  std::jthread left_thread_, right_thread_;
};

}  // namespace stereod
