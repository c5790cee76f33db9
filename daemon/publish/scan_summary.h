// SPDX-License-Identifier: BSD-3-Clause
// The obstacle scan's part of the frame summary.
#pragma once

#include <cstdint>

namespace stereod {

/// Why the robot must stop: frame_t's stop_reason.
enum class StopReason : std::int8_t { kNone = 0, kObstacle = 1, kWayUnknown = 2, kGroundUnknown = 3 };

/// The result of the obstacle scan of one frame, as in frame_t. The default is frame_t without a scan.
struct ScanSummary {
  bool stop = false;  ///< the robot must stop
  StopReason stop_reason = StopReason::kNone;
  float nearest_m = 0;       ///< distance of the nearest obstacle ahead [m]; 0: not known
  std::int32_t scan_us = 0;  ///< time spent on the scan [µs]
};

}  // namespace stereod
