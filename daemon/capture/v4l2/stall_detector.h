// SPDX-License-Identifier: BSD-3-Clause
// Decides when a camera that should deliver frames counts as stalled.
#pragma once

#include <cstdint>

namespace stereod::v4l2 {

/// Computes how long to wait for the next frame of one camera. Times are CLOCK_MONOTONIC [ns].
///
///   waiting for                         | timeout
///   ------------------------------------|---------------------------------------------------------------
///   the next frame                      | max(1 s, 4 frame periods)
///   the first frame after a start       | 1.5 × the slowest start since the camera was plugged in, 1…3 s
///   the first frame, if none came since | starts 1, 2, 4, 8, …: 3 s
///   the camera was plugged in           | other starts: 1 s
///
/// The timeout is never shorter than 4 frame periods. Reasons: webcams need up to 2 s for the first frame
/// when they were just plugged in, and most need less later; a camera that only a new start wakes up should
/// get that start soon. A camera whose driver needs up to 0.67 s for its first frame therefore streams again
/// within 2 s of becoming able to.
class StallDetector {
 public:
  /// Forgets the slowest start: another camera may be plugged in, or the same one cold.
  void forget_starts() noexcept {
    slowest_start_ns_ = 0;
    failed_starts_ = 0;
  }

  /// Begins to wait for the first frame of a stream. @p frame_time_ns: its frame period, 0 = unknown.
  void stream_started(std::int64_t now_ns, std::int64_t frame_time_ns) noexcept {
    last_frame_ns_ = now_ns;
    frame_time_ns_ = frame_time_ns;
    has_frame_ = false;
  }

  void frame_received(std::int64_t now_ns) noexcept;

  /// Extends the timeout if this process was not scheduled for @p late_ns: the camera is not to blame.
  void thread_was_late(std::int64_t late_ns) noexcept;

  /// Returns when the camera counts as stalled.
  std::int64_t deadline_ns() const noexcept { return last_frame_ns_ + timeout_ns(); }
  std::int64_t timeout_ns() const noexcept;

  /// Records that the timeout has expired.
  void stalled() noexcept {
    if (!has_frame_) ++failed_starts_;
  }

  /// Returns true if a frame came since the stream was started.
  bool has_frame() const noexcept { return has_frame_; }

 private:
  std::int64_t frame_time_ns_ = 0;
  std::int64_t last_frame_ns_ = 0;  // or the start of the stream
  bool has_frame_ = false;          // since the start of the stream
  std::int64_t slowest_start_ns_ =
      0;                        // from a start to its first frame, since the camera was plugged in; 0 = none
  unsigned failed_starts_ = 0;  // in a row, since the camera was plugged in
};

}  // namespace stereod::v4l2
