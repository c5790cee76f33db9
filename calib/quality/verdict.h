// SPDX-License-Identifier: BSD-3-Clause
// Grades a calibration and gives the reasons.
#pragma once

#include <string>
#include <vector>

namespace stereod::calib {

enum class Grade { kGood, kUsable, kDoAgain };

/// Returns "good", "usable" or "do again".
std::string to_string(Grade grade);

struct Verdict {
  Grade grade = Grade::kGood;
  std::vector<std::string> reasons;  ///< sentences: why the grade is not better, or why it is good
};

/// The numbers that a verdict depends on.
struct QualityStats {
  int pairs_used = 0;
  int outliers = 0;                  ///< pairs rejected as outliers; pairs without a board do not count
  double rms_px = 0;                 ///< reprojection error
  double epipolar_error_px = 0;      ///< mean over held-out pairs
  double max_epipolar_error_px = 0;  ///< largest of a held-out pair
  double left_coverage = 0, right_coverage = 0;  ///< Coverage::share()
  double foldover = 0;                           ///< distortion_foldover() of the worse camera
  std::vector<std::string> empty_parts;          ///< Coverage::empty_parts() of the image with less coverage
};

/// Returns the worst grade of all criteria, with a reason for each criterion that is not good.
Verdict evaluate(const QualityStats& stats);

/// Grades an epipolar error alone: up to 0.25 px good, up to 0.5 px usable. Block matching compares windows in one
/// row; at half a pixel it starts to compare different rows.
Grade grade_of_epipolar_error(double epipolar_error_px);

/// Grades distortion_foldover() alone: 0 good, up to 5 % of the image usable.
Grade grade_of_foldover(double share);

}  // namespace stereod::calib
