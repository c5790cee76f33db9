// The two cameras at work: their threads, and the desk where their frames meet.
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/capture/rig.h"
#include "daemon/pipeline/capture_thread.h"
#include "daemon/pipeline/pairing_desk.h"

namespace stereod {

/// What one camera did since the start.
struct CameraFigures {
  SourceReport report;
  std::int64_t frames = 0;
  double mean_brightness = 0;  ///< of the latest frame, 0…255
};

/// What both did.
struct CamerasFigures {
  CameraFigures left, right;
  PairingCounts pairing;
};

/// The half of the pipeline that a change of the matcher's settings leaves alone: one pipeline after another
/// may take pairs from the same cameras. Destroyed only when no frame is on loan to a pipeline any more.
class Cameras {
 public:
  /// Nothing runs before start().
  Cameras(const CamerasConfig& config, Rig rig);
  ~Cameras();
  Cameras(const Cameras&) = delete;
  Cameras& operator=(const Cameras&) = delete;

  /// Starts a thread for each camera.
  void start();
  /// Ends them and closes the desk.
  void stop() noexcept;

  /// The counts go on from those of the cameras that were there before, which have been stopped.
  void count_on_from(const Cameras& others);
  CamerasFigures figures() const;

  const Rig& rig() const { return rig_; }
  PairingDesk& desk() { return desk_; }

 private:
  const Rig rig_;
  PairingDesk desk_;  // its leases end before their sources do
  std::optional<CaptureThread> left_thread_, right_thread_;
  CamerasFigures before_;
};

}  // namespace stereod
