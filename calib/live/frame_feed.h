// SPDX-License-Identifier: BSD-3-Clause
// Live image pairs.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "calib/base/pair_input.h"
#include "daemon/capture/stereo_capture.h"
#include "daemon/config/config.h"

namespace stereod::calib {

/// The source of a live session's images.
class FrameFeed {
 public:
  virtual ~FrameFeed() = default;

  /// Returns the newest pair; waits for one up to @p timeout [ms]. Returns nothing after the timeout, or if
  /// finished().
  virtual std::optional<ImagePair> next(std::chrono::milliseconds timeout) = 0;

  /// Returns whether a recording has ended: next() will never return a pair again.
  virtual bool finished() const = 0;
};

/// Captures from the cameras of a configuration, exactly as the daemon does. Pairs that arrive between two calls of
/// next() replace each other; a source with `fps: 0` waits for its consumer and loses none.
class CameraFeed final : public FrameFeed {
 public:
  /// Starts capturing. @throws FileError as open_stereo_source() does.
  explicit CameraFeed(const Config& config);

  std::optional<ImagePair> next(std::chrono::milliseconds timeout) override;
  bool finished() const override { return finished_; }

 private:
  StereoCapture capture_;
  std::uint64_t taken_ = 0;
  bool finished_ = false;
};

}  // namespace stereod::calib
