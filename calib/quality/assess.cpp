#include <algorithm>
#include <cmath>

#include "calib/quality/distortion_foldover.h"
#include "calib/report/html.h"
#include "calib/report/report.h"

namespace stereod {

Assessment assess(const SolveResult& result) {
  const Size image = result.calibration.image;
  Assessment a{Coverage(image), Coverage(image), {}, {}};
  int disagreeing = 0;
  for (const PairResult& pair : result.pairs) {
    if (pair.fate == PairFate::kLeftOut) {
      disagreeing += pair.disagrees ? 1 : 0;
      continue;
    }
    a.left.add(pair.corners.left);
    a.right.add(pair.corners.right);
  }
  // What matching adds where it could not be measured: that of an ordinary webcam.
  constexpr double kMatcher_px = 0.3;
  a.depth = {result.matched_error_px.value_or(std::hypot(result.held_back.disparity_error_px, kMatcher_px)),
             std::abs(result.held_back.scale_error)};
  QualityStats figures;
  figures.pairs_used = result.count(PairFate::kUsed);
  figures.pairs_left_out = disagreeing;
  figures.rms_px = result.calibration.quality.rms_px;
  figures.epipolar_error_px = result.held_back.epipolar_error_px;
  figures.max_epipolar_error_px = result.max_epipolar_error_px;
  figures.left_coverage = a.left.share();
  figures.right_coverage = a.right.share();
  figures.breakdown = std::max(distortion_foldover(result.calibration.left.camera),
                               distortion_foldover(result.calibration.right.camera));
  figures.empty_parts = (a.left.share() <= a.right.share() ? a.left : a.right).empty_parts();
  a.verdict = judge(figures);
  return a;
}

std::string summary_text(const SolveResult& result, const Assessment& a) {
  const Calibration& c = result.calibration;
  std::string text = "verdict: " + in_words(a.verdict.grade) + "\n";
  for (const std::string& reason : a.verdict.reasons) text += "  " + reason + "\n";
  text +=
      "board: " + in_words(result.board) + ", squares of " + fixed(1000 * result.board.square_m, 2) + " mm\n";
  text += "pairs: " + std::to_string(result.count(PairFate::kUsed)) +
          " used, each held back once to check with, " + std::to_string(result.count(PairFate::kLeftOut)) +
          " left out\n";
  for (const PairResult& pair : result.pairs) {
    if (pair.fate == PairFate::kLeftOut) text += "  left out: " + pair.name + ": " + pair.reason + "\n";
  }
  text += "reprojection error: " + fixed(c.quality.rms_px, 3) + " px RMS (left alone " +
          fixed(result.left_rms_px, 3) + ", right alone " + fixed(result.right_rms_px, 3) + ")\n";
  text += "row error on pairs held back: " + fixed(result.held_back.epipolar_error_px, 3) + " px mean, " +
          fixed(result.max_epipolar_error_px, 3) + " px in the worst pair\n";
  text += "coverage: left " + fixed(100 * a.left.share(), 0) + " %, right " +
          fixed(100 * a.right.share(), 0) + " %\n";
  text += "focal length: left " + fixed(c.left.camera.fx, 1) + " px, right " + fixed(c.right.camera.fx, 1) +
          " px; rectified " + fixed(c.left.projection.fx, 1) + " px\n";
  text += "baseline: " + fixed(1000 * c.baseline_m, 2) + " mm\n";
  text += "expected depth error:";
  for (const double depth : kReportedDepths_m) {
    text += (depth == kReportedDepths_m.front() ? " " : ", ") +
            length_in_words(expected_depth_error_m(c, a.depth, depth)) + " at " +
            fixed(depth, depth < 1 ? 1 : 0) + " m";
  }
  return text + "\n";
}

}  // namespace stereod
