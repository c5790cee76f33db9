// SPDX-License-Identifier: BSD-3-Clause
// When the simulated camera exposes its frames.
#pragma once

#include <cstdint>

namespace stereod::uvcsim {

/// The camera's own crystal. Times are CLOCK_MONOTONIC [ns].
///
/// The first frame of a stream comes a fixed time after the start. If a phase was set before the start, the
/// first frame comes at that phase of the clock, so that a test knows the skew of two cameras.
class Shutter {
 public:
  static constexpr std::int64_t kStartTime = 60'000'000;  ///< from the start of a stream to its first frame

  void set_phase(std::int64_t phase_ns) { phase_ns_ = phase_ns, phase_set_ = true; }
  /// Sets by how much the frame period is longer [ppm].
  void set_drift(std::int64_t ppm) { drift_ppm_ = ppm; }

  void start(std::int64_t now_ns, std::int64_t frame_time_ns) {
    frame_time_ns_ = frame_time_ns;
    due_ns_ = now_ns + kStartTime;
    if (phase_set_) due_ns_ += frame_time_ns - (due_ns_ - phase_ns_ % frame_time_ns) % frame_time_ns;
    phase_set_ = false;
    frame_ = 0;
  }

  std::int64_t due_ns() const { return due_ns_; }
  /// Returns the number of frames since the start, including those that the host did not fetch.
  std::int64_t frame() const { return frame_; }

  /// Advances to the next frame after @p now_ns.
  void advance(std::int64_t now_ns) {
    const std::int64_t interval = frame_time_ns_ + frame_time_ns_ * drift_ppm_ / 1'000'000;
    const std::int64_t frames = now_ns < due_ns_ ? 1 : (now_ns - due_ns_) / interval + 1;
    due_ns_ += frames * interval;
    frame_ += frames;
  }

 private:
  std::int64_t phase_ns_ = 0;
  bool phase_set_ = false;
  std::int64_t drift_ppm_ = 0;
  std::int64_t frame_time_ns_ = 33'333'300;
  std::int64_t due_ns_ = 0;
  std::int64_t frame_ = 0;
};

}  // namespace stereod::uvcsim
