// What stereo-tap check found, in numbers and in words.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/client/stereod_client.h"

namespace stereod {

/// Times of many frames.
struct Spread {
  double median = 0;
  double p95 = 0;  ///< 95 % of them are no longer
  double max = 0;
};

/// Median, 95th percentile (nearest rank) and maximum; zeros if there are none.
Spread spread_of(std::vector<double> values);

/// Collects while messages arrive.
struct Reception {
  ReceptionCounts counts;
  std::vector<double> arrival_ms;  ///< from the left exposure until the frame was complete here
  std::vector<double>
      latency_ms;                ///< from the later exposure until the last row was sent, as the daemon says
  std::int64_t first_utime = 0;  ///< exposure of the first and last complete frame, µs
  std::int64_t last_utime = 0;
  std::int64_t frames = 0;  ///< complete ones, settled or not

  /// Frames a second, from the exposure times; 0 if there are fewer than two.
  double fps() const;
  bool anything_arrived() const { return counts.frames_complete + counts.frames_incomplete > 0; }
  bool anything_lost() const {
    return counts.frames_incomplete + counts.frames_missing + counts.rows_lost + counts.messages_of_another >
           0;
  }
};

/// The report as lines of text.
std::vector<std::string> report_lines(const Reception& reception);

}  // namespace stereod
