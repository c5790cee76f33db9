// SPDX-License-Identifier: BSD-3-Clause
// Timeouts of a camera.
#include "daemon/capture/v4l2/stall_detector.h"

#include <algorithm>
#include <bit>

namespace stereod::v4l2 {
namespace {

constexpr std::int64_t kFrameTimeout = 1'000'000'000;
constexpr std::int64_t kMaxStartTimeout = 3'000'000'000;
constexpr std::int64_t kFramePeriods = 4;
constexpr std::int64_t kToleratedDelay = kFrameTimeout / 4;

}  // namespace

void StallDetector::frame_received(std::int64_t now_ns) noexcept {
  if (!has_frame_) slowest_start_ns_ = std::max(slowest_start_ns_, now_ns - last_frame_ns_);
  failed_starts_ = 0;
  last_frame_ns_ = now_ns;
  has_frame_ = true;
}

void StallDetector::thread_was_late(std::int64_t late_ns) noexcept {
  if (late_ns > kToleratedDelay) last_frame_ns_ += late_ns;
}

std::int64_t StallDetector::timeout_ns() const noexcept {
  std::int64_t start_ns = 0;
  if (!has_frame_) {
    const bool never_started = slowest_start_ns_ == 0;
    const bool is_long_start = std::has_single_bit(failed_starts_ + 1);
    start_ns = never_started && is_long_start ? kMaxStartTimeout : slowest_start_ns_ + slowest_start_ns_ / 2;
  }
  return std::max({kFrameTimeout, std::min(start_ns, kMaxStartTimeout), kFramePeriods * frame_time_ns_});
}

}  // namespace stereod::v4l2
