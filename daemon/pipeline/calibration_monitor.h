// SPDX-License-Identifier: BSD-3-Clause
// Decides whether the calibration still fits the cameras.
#pragma once

#include <string>

#include "daemon/pipeline/epipolar_monitor.h"

namespace stereod {

/// Whether the calibration fits the cameras.
enum class CalibrationFit {
  kGood,        ///< it fits, or nothing speaks against it
  kMisaligned,  ///< the epipolar error is above its limit
  kNoMatches,   ///< hardly any point of the left image is found in the right image
};

/// Returns true if distances cannot be trusted.
constexpr bool calibration_lost(CalibrationFit fit) { return fit != CalibrationFit::kGood; }

/// Follows the epipolar statistics of one calibration. A calibration is lost once the epipolar error exceeds
/// 1 px, until it is below 0.7 px; or once hardly any point is found in the right image although points were
/// found before, until a third of the usual share is found again.
class CalibrationMonitor {
 public:
  /// Takes the statistics of about the last second.
  CalibrationFit judge(const EpipolarStats& stats);

 private:
  bool misaligned_ = false;
  bool matched_before_ = false;
  bool no_matches_ = false;
};

/// Returns what was found, the limit, and what to do; empty for kGood.
std::string describe(CalibrationFit fit, const EpipolarStats& stats);

}  // namespace stereod
