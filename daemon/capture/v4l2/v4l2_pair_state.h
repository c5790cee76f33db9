// SPDX-License-Identifier: BSD-3-Clause
// What the two cameras of a pair must know of each other.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/sync/pairing.h"
#include "core/sync/phase_sync.h"
#include "daemon/capture/v4l2/stream_setup.h"
#include "daemon/config/config.h"

namespace stereod::v4l2 {

/// Exposure time and gain of a camera; a control that the camera does not have is missing.
struct ExposureValues {
  std::optional<std::int32_t> time;  ///< exposure_time_absolute [100 µs]
  std::optional<std::int32_t> gain;
  friend bool operator==(const ExposureValues&, const ExposureValues&) = default;
};

/// State of the synchronization of exposure (core/sync/phase_sync.h), for the status message.
struct PhaseSyncReport {
  PhaseSyncState state = PhaseSyncState::kWaiting;
  double skew_ms = 0;         ///< right − left [ms]
  std::int64_t restarts = 0;  ///< of one camera's stream, since the start
};
/// Returns the word of the status message: off, waiting, measuring, restarting, aligned, drifted, given up.
std::string_view name_of(PhaseSyncState state);

/// The state that two cameras share: which device each one uses, the format fallback and the bandwidth of
/// their bus, the synchronization of their exposure times, exposure values, and controls.
///
/// Threads: all members may be called from any thread; each camera's thread calls those with its side.
/// Nothing blocks for longer than the lock is held.
class V4l2PairState {
 public:
  explicit V4l2PairState(const CamerasConfig& config);

  /// Claims a device (VideoSystem::camera_id()) for one side; an empty name gives the claim up because the
  /// camera is unplugged. Returns false if the other camera has claimed the device.
  bool claim_device(Side side, const std::string& device);

  /// Records how a camera was set up, and whether it delivers frames.
  void set_stream_info(Side side, const StreamInfo& info);
  void set_streaming(Side side, bool streaming);

  // Synchronization of exposure (PhaseSync). All times are CLOCK_MONOTONIC.

  void stream_started(Side side, std::int64_t at_ns) noexcept;
  void stream_stopped(Side side) noexcept;
  /// Records a frame. Returns true if this camera's stream must be restarted, at best_start().
  bool frame_received(Side side, std::int64_t captured_ns) noexcept;
  /// Returns when to start the stream so that its frames coincide with the other camera's; not before @p
  /// ready_ns.
  std::int64_t best_start(std::int64_t ready_ns) noexcept;
  PhaseSyncReport sync_report() noexcept;

  // Exposure values that both cameras should have; nothing until the left camera has shared its own.

  void set_exposure(const ExposureValues& values) noexcept;
  std::optional<ExposureValues> exposure() noexcept;

  // Controls and exposure mode.

  /// Replaces them for both cameras, which apply them between two frames or when they are set up next.
  /// Discards the shared exposure.
  void set_controls(const V4l2Config& config);
  /// Returns them. @p number increases with every change.
  V4l2Config controls(int& number);
  int controls_number() const noexcept { return controls_number_; }

  // Format fallbacks (format_fallbacks.h).

  /// Returns the fallback level of both cameras; 0 is the best format. They share one level because two
  /// cameras on one bus share its bandwidth, and because matching needs two equal images. The level returns
  /// to 0 when both cameras are unplugged, and when one comes back on another bus. A camera that streams is
  /// not interrupted to try a better one.
  int fallback_level() const noexcept { return fallback_level_; }
  /// Requests the level after @p level, at which @p side could not get its bandwidth. Returns true if both
  /// cameras must now be set up with a higher level, false if the configuration names a format or there is no
  /// further fallback.
  bool fall_back(Side side, int level);

  /// Returns true if missing frames of @p side may be due to a full bus: the other camera was started on the
  /// same bus, and the bus has not yet carried both streams at this level.
  bool may_lack_bandwidth(Side side);

  /// Returns a sentence that names the full bus, the streams of both cameras, and what to do.
  std::string bandwidth_sentence(Side side);

 private:
  struct Camera {
    bool present() const { return !device.empty(); }

    std::string device;  // claimed
    StreamInfo info;
    std::string bus;         // of the camera now, or when it was last plugged in
    bool started = false;    // the stream
    bool streaming = false;  // frames arrive
  };
  bool on_same_bus() const;
  void reset_fallbacks();
  Camera& camera(Side side) { return cameras_[side == Side::kLeft ? 0 : 1]; }

  CamerasConfig config_;
  std::atomic<int> controls_number_{0};
  std::mutex mutex_;
  Camera cameras_[2];
  std::atomic<int> fallback_level_{0};
  int proven_level_ = -1;  // fallback level at which one bus has carried both streams
  PhaseSync phase_sync_;
  std::optional<ExposureValues> exposure_;
};

/// Returns the bus in a device's bus_info: "usb-0000:00:14.0" for "usb-0000:00:14.0-3.1".
std::string bus_of(const std::string& bus_info);

}  // namespace stereod::v4l2
