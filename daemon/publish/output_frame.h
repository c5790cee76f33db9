// A frame's result on its way from the workers to the network.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/match/disparity.h"

namespace stereod {

/// What a frame was made of and when; times in CLOCK_MONOTONIC ns.
struct FrameTiming {
  std::int64_t frame = 0;  ///< number of the pair
  std::int64_t utime = 0;  ///< left_ns in µs since the Unix epoch: the same in all messages of the frame
  std::int64_t left_ns = 0, right_ns = 0;
  std::uint32_t left_sequence = 0, right_sequence = 0;
  std::int64_t started_ns = 0;  ///< the first worker began
  std::int64_t rectify_ns = 0;  ///< spent, mean over the workers
  std::int64_t match_ns = 0;    ///< likewise
  std::int64_t filter_ns = 0;   ///< spent on filters that need the whole frame
  std::int64_t matched_ns = 0;  ///< the last row was final
};

/// The disparities of one frame and where they come from.
struct OutputFrame {
  explicit OutputFrame(Size size) : disparity(size) {
    for (int y = 0; y < size.height; ++y) std::fill_n(disparity.row(y), size.width, kInvalidDisparity);
  }
  DisparityImage disparity;  ///< of the whole rectified image; never written outside the published region
  FrameTiming timing;
};

}  // namespace stereod
