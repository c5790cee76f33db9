// Is a calibration any good? In words.
#pragma once

#include <string>
#include <vector>

namespace stereod {

enum class Grade { kGood, kUsable, kDoAgain };

/// "good", "usable", "do again".
std::string in_words(Grade grade);

struct Verdict {
  Grade grade = Grade::kGood;
  std::vector<std::string> reasons;  ///< sentences: why it is not better, or why it is good
};

/// The numbers that decide.
struct QualityStats {
  int pairs_used = 0;
  int pairs_left_out = 0;  ///< for disagreeing, not for want of a board
  double rms_px = 0;
  double epipolar_error_px = 0;                  ///< mean, on pairs held back
  double max_epipolar_error_px = 0;              ///< of one such pair
  double left_coverage = 0, right_coverage = 0;  ///< 0 … 1
  double breakdown = 0;                          ///< share of the images where a lens model has no inverse
  std::vector<std::string> empty_parts;          ///< Coverage::empty_parts() of the emptier image
};

Verdict judge(const QualityStats& figures);

/// The grade of a row error alone: up to 0.25 px good, up to 0.5 px usable. Block matching looks along one
/// row; half a pixel off, it starts to compare other rows.
Grade grade_of_epipolar_error(double epipolar_error_px);

/// The grade of distortion_foldover() alone: none is good, up to a twentieth of the image usable.
Grade grade_of_foldover(double share);

}  // namespace stereod
