// SPDX-License-Identifier: BSD-3-Clause
#include "calib/report/summary.h"

#include "calib/base/text.h"

namespace stereod::calib {

std::string summary_text(const SolveResult& result, const Assessment& a) {
  const Calibration& c = result.calibration;
  std::string text = "verdict: " + to_string(a.verdict.grade) + "\n";
  for (const std::string& reason : a.verdict.reasons) text += "  " + reason + "\n";
  text += "board: " + to_string(result.board) + ", squares of " + fixed(1000 * result.board.square_m, 2) +
          " mm\n";
  text += "pairs: " + std::to_string(result.count(PairOutcome::kUsed)) + " used, " +
          std::to_string(result.count(PairOutcome::kRejected)) + " rejected\n";
  for (const PairResult& pair : result.pairs) {
    if (pair.outcome == PairOutcome::kRejected)
      text += "  rejected: " + pair.name + ": " + pair.reason + "\n";
  }
  text += "reprojection error: " + fixed(c.quality.rms_px, 3) + " px RMS (left camera alone " +
          fixed(result.left_rms_px, 3) + " px, right camera alone " + fixed(result.right_rms_px, 3) +
          " px)\n";
  text += "epipolar error on held-out pairs: " + fixed(result.held_out.epipolar_error_px, 3) + " px mean, " +
          fixed(result.max_epipolar_error_px, 3) + " px in the worst pair\n";
  text += "coverage: left " + fixed(100 * a.left.share(), 0) + " %, right " +
          fixed(100 * a.right.share(), 0) + " %\n";
  text += "focal length: left " + fixed(c.left.camera.fx, 1) + " px, right " + fixed(c.right.camera.fx, 1) +
          " px, rectified " + fixed(c.left.projection.fx, 1) + " px\n";
  text += "baseline: " + fixed(1000 * c.baseline_m, 2) + " mm\n";
  text += "expected depth error:";
  for (const double depth : kReportedDepths_m) {
    text += (depth == kReportedDepths_m.front() ? " " : ", ") +
            format_length(expected_depth_error_m(c, a.depth, depth)) + " at " +
            fixed(depth, depth < 1 ? 1 : 0) + " m";
  }
  return text + "\n";
}

}  // namespace stereod::calib
