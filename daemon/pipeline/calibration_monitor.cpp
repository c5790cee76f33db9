// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline/calibration_monitor.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>

namespace stereod {
namespace {

constexpr double kErrorLimit_px = 1;
constexpr double kRecoveredError_px = 0.7;
constexpr std::size_t kMinSearched = 100;  // fewer points say nothing about the share that is found

constexpr const char* kRemedy =
    "Run 'stereo-calibrate check --daemon' to measure it, and calibrate again if it confirms the error";

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

CalibrationFit CalibrationMonitor::judge(const EpipolarStats& stats) {
  if (stats.epipolar_error) {
    misaligned_ =
        stats.epipolar_error->epipolar_error_px > (misaligned_ ? kRecoveredError_px : kErrorLimit_px);
    matched_before_ = true;
  }
  // Without a measurement the verdict stays: only a small measured error shows that the cameras are aligned
  // again.
  if (misaligned_) return CalibrationFit::kMisaligned;
  if (stats.searched >= kMinSearched) {
    const double lost_below = std::max(0.01, stats.usual_share / 8);
    const double recovered_above = std::max(0.05, stats.usual_share / 3);
    no_matches_ = matched_before_ && stats.found_share < (no_matches_ ? recovered_above : lost_below);
  }
  return no_matches_ ? CalibrationFit::kNoMatches : CalibrationFit::kGood;
}

std::string describe(CalibrationFit fit, const EpipolarStats& stats) {
  constexpr const char* kMoved = "the cameras have moved relative to each other. ";
  switch (fit) {
    case CalibrationFit::kGood:
      return {};
    case CalibrationFit::kMisaligned: {
      if (!stats.epipolar_error) {
        return formatted("epipolar error above %.0f px (too few points to measure it now): ",
                         kErrorLimit_px) +
               kMoved + kRemedy;
      }
      const double error_px = stats.epipolar_error->epipolar_error_px;
      const double limit_px = error_px > kErrorLimit_px ? kErrorLimit_px : kRecoveredError_px;
      return formatted("epipolar error %.1f px (limit %.2g px): ", error_px, limit_px) + kMoved + kRemedy;
    }
    case CalibrationFit::kNoMatches:
      return formatted(
                 "only %.0f %% of the points of the left image found in the right image (usually %.0f %%): ",
                 100 * stats.found_share, 100 * stats.usual_share) +
             "a lens is covered, something is very near, or " + kMoved + kRemedy;
  }
  return {};
}

}  // namespace stereod
