// The two cameras at work: their threads, and the desk where their frames meet.
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/capture/capture_thread.h"
#include "daemon/capture/pair_queue.h"
#include "daemon/capture/stereo_source.h"

namespace stereod {

/// What one camera did since the start.
struct CameraStats {
  SourceReport report;
  std::int64_t frames = 0;
  double mean_brightness = 0;  ///< of the latest frame, 0…255
};

/// What both did.
struct CaptureStats {
  CameraStats left, right;
  PairingCounts pairing;
};

/// The half of the pipeline that a change of the matcher's settings leaves alone: one pipeline after another
/// may take pairs from the same cameras. Destroyed only when no frame is on loan to a pipeline any more.
class StereoCapture {
 public:
  /// Nothing runs before start().
  StereoCapture(const CamerasConfig& config, StereoSource rig);
  ~StereoCapture();
  StereoCapture(const StereoCapture&) = delete;
  StereoCapture& operator=(const StereoCapture&) = delete;

  /// Starts a thread for each camera.
  void start();
  /// Ends them and closes the desk.
  void stop() noexcept;

  /// The counts go on from those of the cameras that were there before, which have been stopped.
  void count_on_from(const StereoCapture& others);
  CaptureStats stats() const;

  const StereoSource& rig() const { return rig_; }
  PairQueue& pair_queue() { return pair_queue_; }

 private:
  const StereoSource rig_;
  PairQueue pair_queue_;  // its leases end before their sources do
  std::optional<CaptureThread> left_thread_, right_thread_;
  CaptureStats before_;
};

}  // namespace stereod
