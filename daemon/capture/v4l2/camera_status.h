// SPDX-License-Identifier: BSD-3-Clause
// What one camera tells about itself.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

#include "core/sync/pairing.h"
#include "daemon/capture/frame_source.h"
#include "daemon/capture/v4l2/camera_fault.h"

namespace stereod::v4l2 {

enum class LogLevel { kInfo, kWarning };
/// Takes a sentence for the log. Called when a camera's state changes, never for a frame.
using CameraLog = std::function<void(LogLevel level, const std::string& sentence)>;

/// Keeps the state of one camera with its reason, and logs each change of the reason once.
///
/// Threads: the camera's thread changes it, any thread reads it.
class CameraStatus {
 public:
  CameraStatus(Side side, CameraLog log);

  SourceState state() const noexcept { return state_; }
  /// Returns why the camera does not stream; kNone while it does.
  CameraFault fault() const;
  /// Returns true if the camera has ever streamed.
  bool has_streamed() const;
  /// Writes everything but the counters of frames.
  void fill(SourceReport& report) const;

  /// Records that the device is set up. A stalled or lost camera keeps that state until a frame arrives.
  void opened(std::string device, std::string format);
  /// Records the first frame after a fault or since the beginning.
  void streaming();
  /// Records a failure at @p now_ns. A stalled or lost camera that cannot be set up again keeps its state.
  void failed(SourceState state, CameraFault fault, std::int64_t now_ns);
  /// Records a failure without describing it, for when there is no memory for a description.
  void failed_silently() noexcept { state_ = SourceState::kLost; }
  /// Replaces the note about controls.
  void set_note(const std::string& note);

 private:
  void log(LogLevel level, const std::string& sentence) const;

  const Side side_;
  const CameraLog log_;
  std::atomic<SourceState> state_{SourceState::kAbsent};

  mutable std::mutex mutex_;  // guards the members below
  CameraFault fault_;
  CameraReason logged_ = CameraReason::kNone;
  bool has_streamed_ = false;
  std::string device_, format_, note_, last_fault_;
  std::int64_t last_fault_ns_ = 0;
  std::int64_t reconnects_ = 0;
};

}  // namespace stereod::v4l2
