// SPDX-License-Identifier: BSD-3-Clause
// Two cameras at work: their threads, and the queue in which their frames become pairs.
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
  double mean_brightness = 0;  ///< of the latest frame [0…255]
};

/// What both cameras did since the start.
struct CaptureStats {
  CameraStats left, right;
  PairingCounts pairing;
};

/// Owns the two sources, a capture thread for each, and the pair queue between those threads and the
/// consumer.
///
/// Life: construct, start(), take pairs from pair_queue(), stop(). A pipeline holds it by shared pointer;
/// when only the matcher's settings change, the next pipeline takes pairs from the same StereoCapture and the
/// cameras stream on. When the cameras themselves change, a second StereoCapture takes over the counters
/// (count_on_from()).
///
/// Every lease must have ended, including those in the queue (PairQueue::clear()), before this is destroyed.
class StereoCapture {
 public:
  /// Starts no thread and opens no device; start() does.
  StereoCapture(const CamerasConfig& config, StereoSource source);
  ~StereoCapture();
  StereoCapture(const StereoCapture&) = delete;
  StereoCapture& operator=(const StereoCapture&) = delete;

  /// Starts one thread for each camera. Call once.
  void start();
  /// Joins the threads and closes the pair queue.
  void stop() noexcept;

  /// Adds the counters of @p previous, which must have been stopped, to those of this capture.
  void count_on_from(const StereoCapture& previous);
  /// Any thread; allocates.
  CaptureStats stats() const;

  const StereoSource& rig() const { return source_; }
  PairQueue& pair_queue() { return pair_queue_; }

 private:
  const StereoSource source_;
  PairQueue pair_queue_;  // destroyed before the sources: its leases end first
  std::optional<CaptureThread> left_thread_, right_thread_;
  CaptureStats previous_;
};

}  // namespace stereod
