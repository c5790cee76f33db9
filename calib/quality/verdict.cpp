#include "calib/quality/verdict.h"

#include <algorithm>

#include "daemon/base/text.h"

namespace stereod {

namespace {

constexpr double kGoodRow_px = 0.25, kUsableRow_px = 0.5;
constexpr double kGoodRms_px = 0.5, kUsableRms_px = 1.0;
constexpr double kGoodCoverage = 0.6, kUsableCoverage = 0.3;
constexpr double kUsableBreakdown = 0.05;
constexpr int kGoodPairs = 8;

std::string percent(double share) { return fixed(100 * share, 0) + " %"; }

Grade grade_of(double value, double good, double usable) {
  if (value <= good) return Grade::kGood;
  return value <= usable ? Grade::kUsable : Grade::kDoAgain;  // a NaN is no good either
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(words.size(), 3); ++i) {
    if (i > 0) text += i + 1 == std::min<std::size_t>(words.size(), 3) ? " and " : ", ";
    text += words[i];
  }
  return text;
}

// Collects the worst grade and the sentence for it.
class VerdictBuilder {
 public:
  void hear(Grade grade, const std::string& sentence) {
    if (grade == Grade::kGood) return;
    verdict_.grade = std::max(verdict_.grade, grade);
    verdict_.reasons.push_back(sentence);
  }
  Verdict verdict() && { return std::move(verdict_); }

 private:
  Verdict verdict_;
};

}  // namespace

std::string in_words(Grade grade) {
  return grade == Grade::kGood ? "good" : grade == Grade::kUsable ? "usable" : "do again";
}

Grade grade_of_epipolar_error(double epipolar_error_px) {
  return grade_of(epipolar_error_px, kGoodRow_px, kUsableRow_px);
}

Grade grade_of_foldover(double share) { return grade_of(share, 0, kUsableBreakdown); }

Verdict judge(const QualityStats& f) {
  VerdictBuilder jury;
  jury.hear(grade_of_epipolar_error(f.epipolar_error_px),
            "Rows of the two rectified images are " + fixed(f.epipolar_error_px, 2) +
                " px apart on pairs that were held back; up to " + fixed(kGoodRow_px, 2) +
                " is good, above " + fixed(kUsableRow_px, 1) + " the matcher loses points.");
  jury.hear(f.max_epipolar_error_px <= 4 * kGoodRow_px ? Grade::kGood : Grade::kUsable,
            "One pair that was held back is " + fixed(f.max_epipolar_error_px, 2) +
                " px off: a part of the image, or a distance, was not calibrated with.");
  jury.hear(
      grade_of(f.rms_px, kGoodRms_px, kUsableRms_px),
      "Corners are " + fixed(f.rms_px, 2) + " px from where they belong; up to " + fixed(kGoodRms_px, 1) +
          " is good. Is the board flat and stiff, were cameras and board still, is the lens model right?");
  const double coverage = std::min(f.left_coverage, f.right_coverage);
  jury.hear(coverage >= kGoodCoverage     ? Grade::kGood
            : coverage >= kUsableCoverage ? Grade::kUsable
                                          : Grade::kDoAgain,
            "The board was seen in only " + percent(coverage) + " of the " +
                (f.left_coverage <= f.right_coverage ? "left" : "right") + " image" +
                (f.empty_parts.empty() ? "" : ", not in " + list_of(f.empty_parts)) +
                "; depth there is not to be trusted.");
  jury.hear(grade_of_foldover(f.breakdown),
            "The lens model breaks down in " + fixed(100 * f.breakdown, 1) +
                " % of the images: it has more coefficients than these images can hold. Show the board there "
                "too, or choose a lens model with fewer of them.");
  jury.hear(f.pairs_used >= kGoodPairs ? Grade::kGood : Grade::kUsable,
            "Only " + std::to_string(f.pairs_used) + " pairs were calibrated with; 15 and more are better.");
  jury.hear(2 * f.pairs_left_out <= f.pairs_used ? Grade::kGood : Grade::kDoAgain,
            std::to_string(f.pairs_left_out) +
                " pairs do not agree with the rest: did the board move, or do the cameras not take their "
                "images at the same moment?");
  Verdict verdict = std::move(jury).verdict();
  if (verdict.grade == Grade::kGood) {
    verdict.reasons.push_back("Rows of the two rectified images are within " + fixed(f.epipolar_error_px, 2) +
                              " px of each other on pairs that were held back, and the board was seen in " +
                              percent(coverage) + " of the image or more.");
  }
  return verdict;
}

}  // namespace stereod
