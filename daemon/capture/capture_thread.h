// SPDX-License-Identifier: BSD-3-Clause
// The thread of one camera.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "core/sync/pairing.h"
#include "daemon/capture/frame_source.h"
#include "daemon/capture/pair_queue.h"

namespace stereod {

/// Moves frames from a source to the pair queue until the source finishes or stop() is called.
///
/// When the source stops streaming, the thread withdraws the frame that waits in the queue: a camera can only
/// be set up again when none of its frames is on loan. When the source streams again, the thread reports its
/// frame period.
class CaptureThread {
 public:
  /// Starts the thread. @p source and @p pair_queue must outlive it.
  CaptureThread(Side side, FrameSource& source, PairQueue& pair_queue);
  ~CaptureThread();
  CaptureThread(const CaptureThread&) = delete;
  CaptureThread& operator=(const CaptureThread&) = delete;

  /// Stops the source and joins the thread.
  void stop() noexcept;

  /// Returns the number of frames delivered since the start. Any thread.
  std::int64_t frames() const noexcept { return frames_; }
  /// Returns the mean brightness of the latest frame [0…255]. Any thread.
  double mean_brightness() const noexcept { return mean_brightness_; }
  SourceReport report() const { return source_.report(); }

 private:
  void run() noexcept;
  void withdraw_waiting_frame() noexcept;

  Side side_;
  FrameSource& source_;
  PairQueue& pair_queue_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::int64_t> frames_{0};
  std::atomic<double> mean_brightness_{0};
  bool interrupted_ = true;  // no frame came since the source last stopped streaming
  std::thread thread_;
};

}  // namespace stereod
