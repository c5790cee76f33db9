// SPDX-License-Identifier: BSD-3-Clause
#include "calib/quality/assessment.h"

#include <algorithm>
#include <cmath>

#include "calib/quality/distortion_foldover.h"

namespace stereod::calib {

Assessment assess(const SolveResult& result) {
  const Size image = result.calibration.image;
  Assessment a{Coverage(image), Coverage(image), {}, {}};
  QualityStats stats;
  for (const PairResult& pair : result.pairs) {
    stats.outliers += pair.outcome == PairOutcome::kRejected && pair.is_outlier ? 1 : 0;
    if (pair.outcome == PairOutcome::kRejected) continue;
    a.left.add(pair.corners.left);
    a.right.add(pair.corners.right);
  }
  // The matcher's error with an ordinary webcam; used where it could not be measured.
  constexpr double kTypicalMatcherError_px = 0.3;
  a.depth = {result.matched_error_px.value_or(
                 std::hypot(result.held_out.disparity_error_px, kTypicalMatcherError_px)),
             std::abs(result.held_out.scale_error)};
  stats.pairs_used = result.count(PairOutcome::kUsed);
  stats.rms_px = result.calibration.quality.rms_px;
  stats.epipolar_error_px = result.held_out.epipolar_error_px;
  stats.max_epipolar_error_px = result.max_epipolar_error_px;
  stats.left_coverage = a.left.share();
  stats.right_coverage = a.right.share();
  stats.foldover = std::max(distortion_foldover(result.calibration.left.camera),
                            distortion_foldover(result.calibration.right.camera));
  stats.empty_parts = (a.left.share() <= a.right.share() ? a.left : a.right).empty_parts();
  a.verdict = evaluate(stats);
  return a;
}

}  // namespace stereod::calib
