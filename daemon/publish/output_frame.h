// SPDX-License-Identifier: BSD-3-Clause
// The result of one frame on its way from the workers to the network.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/match/disparity.h"

namespace stereod {

/// Origin and durations of one frame. Points in time are CLOCK_MONOTONIC [ns], durations [ns].
struct FrameTiming {
  std::int64_t frame = 0;  ///< number of the pair
  std::int64_t utime = 0;  ///< left_ns in µs since the Unix epoch; the same in all messages of the frame
  std::int64_t left_ns = 0, right_ns = 0;  ///< start of exposure
  std::uint32_t left_sequence = 0, right_sequence = 0;
  std::int64_t started_ns = 0;  ///< when the first worker began
  std::int64_t rectify_ns = 0;  ///< duration, mean over the workers
  std::int64_t match_ns = 0;    ///< duration, mean over the workers
  std::int64_t filter_ns = 0;   ///< duration of the filters that need the whole frame
  std::int64_t matched_ns = 0;  ///< when the last row was final
};

/// The disparities of one frame and their origin.
struct OutputFrame {
  /// @p size is the size of the rectified image [px]. Every pixel starts invalid.
  explicit OutputFrame(Size size) : disparity(size) {
    for (int y = 0; y < size.height; ++y) std::fill_n(disparity.row(y), size.width, kInvalidDisparity);
  }
  DisparityImage disparity;  ///< of the whole rectified image; outside the published region it stays invalid
  FrameTiming timing;
};

}  // namespace stereod
