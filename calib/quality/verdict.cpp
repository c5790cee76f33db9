// SPDX-License-Identifier: BSD-3-Clause
#include "calib/quality/verdict.h"

#include <algorithm>
#include <utility>

#include "calib/base/text.h"

namespace stereod::calib {

namespace {

constexpr double kGoodEpipolar_px = 0.25, kUsableEpipolar_px = 0.5;
constexpr double kGoodRms_px = 0.5, kUsableRms_px = 1.0;
constexpr double kGoodCoverage = 0.6, kUsableCoverage = 0.3;
constexpr double kUsableFoldover = 0.05;
constexpr int kGoodPairs = 8;

std::string percent(double share, int digits = 0) { return fixed(100 * share, digits) + " %"; }

Grade grade_of(double value, double good, double usable) {
  if (value <= good) return Grade::kGood;
  return value <= usable ? Grade::kUsable : Grade::kDoAgain;  // also for NaN
}

// Returns the first three names: "a, b and c".
std::string enumeration(const std::vector<std::string>& names) {
  const std::size_t count = std::min<std::size_t>(names.size(), 3);
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) text += i + 1 == count ? " and " : ", ";
    text += names[i];
  }
  return text;
}

// Collects the worst grade and the reasons for it.
class VerdictBuilder {
 public:
  void add(Grade grade, const std::string& reason) {
    if (grade == Grade::kGood) return;
    verdict_.grade = std::max(verdict_.grade, grade);
    verdict_.reasons.push_back(reason);
  }
  Verdict verdict() && { return std::move(verdict_); }

 private:
  Verdict verdict_;
};

void add_errors(VerdictBuilder& verdict, const QualityStats& stats) {
  verdict.add(grade_of_epipolar_error(stats.epipolar_error_px),
              "Epipolar error " + fixed(stats.epipolar_error_px, 2) + " px on held-out pairs (good up to " +
                  fixed(kGoodEpipolar_px, 2) + " px, usable up to " + fixed(kUsableEpipolar_px, 1) +
                  " px): the matcher loses points.");
  verdict.add(stats.max_epipolar_error_px <= 4 * kGoodEpipolar_px ? Grade::kGood : Grade::kUsable,
              "Epipolar error " + fixed(stats.max_epipolar_error_px, 2) +
                  " px on the worst held-out pair (good up to " + fixed(4 * kGoodEpipolar_px, 0) +
                  " px): the other pairs do not cover its part of the image or its distance.");
  verdict.add(
      grade_of(stats.rms_px, kGoodRms_px, kUsableRms_px),
      "Reprojection error " + fixed(stats.rms_px, 2) + " px RMS (good up to " + fixed(kGoodRms_px, 1) +
          " px, usable up to " + fixed(kUsableRms_px, 0) +
          " px). Check that the board is flat and stiff, that board and cameras were still, and that the "
          "lens model is right.");
}

void add_coverage(VerdictBuilder& verdict, const QualityStats& stats) {
  const double coverage = std::min(stats.left_coverage, stats.right_coverage);
  verdict.add(coverage >= kGoodCoverage     ? Grade::kGood
              : coverage >= kUsableCoverage ? Grade::kUsable
                                            : Grade::kDoAgain,
              "The board covers only " + percent(coverage) + " of the " +
                  (stats.left_coverage <= stats.right_coverage ? "left" : "right") + " image" +
                  (stats.empty_parts.empty() ? "" : ", too little of " + enumeration(stats.empty_parts)) +
                  "; depth is unreliable there.");
  verdict.add(
      grade_of_foldover(stats.foldover),
      "The distortion model folds over in " + percent(stats.foldover, 1) +
          " of the image: it has more coefficients than the pairs determine. Show the board there too, or "
          "choose a lens model with fewer coefficients.");
}

void add_pairs(VerdictBuilder& verdict, const QualityStats& stats) {
  verdict.add(stats.pairs_used >= kGoodPairs ? Grade::kGood : Grade::kUsable,
              "Only " + std::to_string(stats.pairs_used) + " pairs used; 15 or more are better.");
  verdict.add(
      2 * stats.outliers <= stats.pairs_used ? Grade::kGood : Grade::kDoAgain,
      std::to_string(stats.outliers) +
          " pairs are outliers: the board moved while they were taken, or the cameras do not take their "
          "images at the same time.");
}

}  // namespace

std::string to_string(Grade grade) {
  return grade == Grade::kGood ? "good" : grade == Grade::kUsable ? "usable" : "do again";
}

Grade grade_of_epipolar_error(double epipolar_error_px) {
  return grade_of(epipolar_error_px, kGoodEpipolar_px, kUsableEpipolar_px);
}

Grade grade_of_foldover(double share) { return grade_of(share, 0, kUsableFoldover); }

Verdict evaluate(const QualityStats& stats) {
  VerdictBuilder builder;
  add_errors(builder, stats);
  add_coverage(builder, stats);
  add_pairs(builder, stats);
  Verdict verdict = std::move(builder).verdict();
  if (verdict.grade == Grade::kGood) {
    verdict.reasons.push_back("Epipolar error " + fixed(stats.epipolar_error_px, 2) +
                              " px on held-out pairs; the board covers at least " +
                              percent(std::min(stats.left_coverage, stats.right_coverage)) +
                              " of each image.");
  }
  return verdict;
}

}  // namespace stereod::calib
