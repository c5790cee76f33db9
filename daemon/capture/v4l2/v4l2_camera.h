// SPDX-License-Identifier: BSD-3-Clause
// A webcam as a frame source that never gives up.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>

#include "daemon/capture/frame_source.h"
#include "daemon/capture/v4l2/camera_locator.h"
#include "daemon/capture/v4l2/camera_status.h"
#include "daemon/capture/v4l2/camera_stream.h"
#include "daemon/capture/v4l2/exposure_sync.h"
#include "daemon/capture/v4l2/fallback_policy.h"
#include "daemon/capture/v4l2/stall_detector.h"
#include "daemon/capture/v4l2/v4l2_pair_state.h"
#include "daemon/config/config.h"

namespace stereod::v4l2 {

/// One camera of a pair.
///
/// State machine. The state that people see (SourceState) runs for as long as the daemon does:
///
///     absent ──► opening ──► streaming ──► stalled   no frame within the timeout (StallDetector)
///                                    └───► lost      a call failed, or the device was unplugged
///
/// A camera that is stalled or lost keeps that state until a frame arrives, or until its device is found to
/// be missing: then it is absent. Reactions:
///
///   event                                   | reaction
///   ----------------------------------------|-----------------------------------------------------------
///   the device is missing                   | searched for when a device changes (Waiter), else every 1 s
///   setup or a call fails                   | closed, set up again after 0.5 s
///   no frame within the timeout             | closed, set up again at once
///   the bus is full, or a format is refused | both cameras fall back to the next format (FallbackPolicy)
///   the other camera fell back              | closed, set up again at once with the common level
///   out of phase with the other camera      | stream restarted at the computed time (PhaseSync)
///   the configured controls changed         | set between two frames (ExposureSync)
///
/// Below that, the lifecycle of the device has three stages, which run_once() moves through:
///
///   closed     no device is open; waits for the time of the next attempt, then sets the camera up
///   streaming  waits for frames and lends them
///   closing    the stream is stopped; waits until no buffer is on loan, then closes the device
///
/// Neither camera ever waits for the other one. What they share is in V4l2PairState.
///
/// Threads: next() belongs to the camera's thread; see FrameSource. An exception inside next() can only mean
/// that there is no memory for a list or a sentence; the camera is then lost and tries again.
class V4l2Camera final : public FrameSource {
 public:
  /// @p system must outlive the camera. @throws std::bad_alloc, std::system_error
  V4l2Camera(VideoSystem& system, std::shared_ptr<V4l2PairState> pair, Side side, const CamerasConfig& config,
             CameraLog log);

  Size frame_size() const override { return {config_.v4l2.width, config_.v4l2.height}; }
  FrameLease next(std::chrono::milliseconds timeout) noexcept override;
  SourceState state() const noexcept override { return status_.state(); }
  void stop() noexcept override;
  SourceReport report() const override;
  std::int64_t frame_time_ns() const noexcept override { return stream_.frame_time_ns(); }

  /// Returns why the camera does not stream; kNone while it does. Any thread.
  CameraFault fault() const { return status_.fault(); }

 private:
  enum class Lifecycle { kClosed, kStreaming, kClosing };

  FrameLease run_once(std::int64_t until_ns);

  // Closed.
  void wait_for_device(std::int64_t until_ns);
  void set_up();
  std::optional<CameraFault> open_device();
  std::optional<CameraFault> start_stream();
  void setup_failed(CameraFault fault);

  // Streaming.
  FrameLease stream_once(std::int64_t until_ns);
  void apply_changes();
  void restart_in_phase();
  void sync_exposure();
  void configure_exposure();
  WaitResult wait_for_frame(std::int64_t until_ns);
  FrameLease fetch(const WaitResult& ready);
  void frame_received(const Frame& frame);
  void check_stalled();

  // Closing.
  void close_when_returned(std::int64_t until_ns);

  void stream_failed(CameraFault fault);
  void fail(SourceState state, CameraFault fault);
  void fail_without_memory(const std::exception& error) noexcept;

  VideoSystem& system_;
  const std::shared_ptr<V4l2PairState> pair_;
  const Side side_;
  const CamerasConfig config_;
  const std::unique_ptr<Waiter> waiter_;
  std::atomic<bool> stopping_{false};
  CameraStatus status_;

  // Used by the camera's thread only.
  CameraLocator locator_;
  CameraStream stream_;
  ExposureSync exposure_;
  FallbackPolicy fallback_;
  StallDetector stall_;
  Lifecycle lifecycle_ = Lifecycle::kClosed;
  std::int64_t retry_ns_ = 0;    // closed: when to set the camera up
  bool restart_wanted_ = false;  // streaming: to bring the camera into phase with the other one
};

}  // namespace stereod::v4l2
