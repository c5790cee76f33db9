// Pairs of live images.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "calib/base/pair_input.h"
#include "core/sync/pairing.h"
#include "daemon/capture/stereo_source.h"
#include "daemon/config/config.h"

namespace stereod {

/// Where a live session's images come from.
class FrameFeed {
 public:
  virtual ~FrameFeed() = default;
  /// The next pair; nothing within the time-out, or ever again if finished().
  virtual std::optional<ImagePair> next(std::chrono::milliseconds timeout) = 0;
  /// A recording has come to its end.
  virtual bool finished() const = 0;
};

/// The configuration's cameras, opened as the daemon opens them, paired as it pairs. Frames that come while a
/// pair is being looked at are dropped, newest wins; only sources with `fps: 0`, which wait for their
/// consumer, lose none.
class CameraFeed final : public FrameFeed {
 public:
  /// Throws what open_stereo_source() throws.
  explicit CameraFeed(const Config& config);
  ~CameraFeed() override;
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  std::optional<ImagePair> next(std::chrono::milliseconds timeout) override;
  bool finished() const override;

 private:
  void read(FrameSource& source, Side side);

  StereoSource rig_;
  bool waits_;  // for a pair to be taken before the next frame
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Pairing<GrayImage> pairing_;
  bool stopping_ = false;
  int running_ = 2;
  std::uint64_t taken_ = 0;
  std::jthread left_thread_, right_thread_;
};

}  // namespace stereod
