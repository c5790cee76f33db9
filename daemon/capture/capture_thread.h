// One camera's thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "core/sync/pairing.h"
#include "daemon/capture/frame_source.h"
#include "daemon/capture/pair_queue.h"

namespace stereod {

/// Carries frames from a source to the desk until the source finishes or is stopped. When the source stops
/// streaming, what still waits at the desk is given back, because a camera can only be set up anew when no
/// frame of it is on loan.
class CaptureThread {
 public:
  /// Starts the thread. Source and desk outlive it.
  CaptureThread(Side side, FrameSource& source, PairQueue& pair_queue);
  ~CaptureThread();
  CaptureThread(const CaptureThread&) = delete;
  CaptureThread& operator=(const CaptureThread&) = delete;

  /// Stops the source and ends the thread.
  void stop() noexcept;

  std::int64_t frames() const noexcept { return frames_; }
  double mean_brightness() const noexcept { return mean_brightness_; }
  SourceReport report() const { return source_.report(); }

 private:
  void run() noexcept;
  void note_interruption() noexcept;

  Side side_;
  FrameSource& source_;
  PairQueue& pair_queue_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::int64_t> frames_{0};
  std::atomic<double> mean_brightness_{0};
  bool interrupted_ = true;  // no frame came since the camera last stopped streaming
  std::thread thread_;
};

}  // namespace stereod
