// SPDX-License-Identifier: BSD-3-Clause
// The report of stereo-tap check.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/client/stereod_client.h"

namespace stereod::tools {

/// Distribution of the times of many frames.
struct Spread {
  double median = 0;
  double p95 = 0;  ///< 95 % of the times are at most this
  double max = 0;
};

/// Returns median, 95th percentile (nearest rank) and maximum; zeros without values.
Spread spread_of(std::vector<double> values);

/// What was received.
struct Reception {
  ReceptionCounts counts;
  std::vector<double> arrival_ms;  ///< from the left exposure until the frame was complete here
  std::vector<double> latency_ms;  ///< latency_us of the frame summaries
  std::int64_t first_utime = 0;    ///< left exposure of the first and last complete frame, µs
  std::int64_t last_utime = 0;
  std::int64_t frames = 0;  ///< complete frames, settled or not

  /// Returns the frame rate by exposure times [Hz]; 0 for fewer than two frames.
  double fps() const;
  bool anything_arrived() const { return counts.frames_complete + counts.frames_incomplete > 0; }
  bool anything_lost() const {
    return counts.frames_incomplete + counts.frames_missing + counts.rows_lost + counts.messages_of_another >
           0;
  }
};

/// Returns the report as lines of text.
std::vector<std::string> report_lines(const Reception& reception);

}  // namespace stereod::tools
