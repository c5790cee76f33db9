// SPDX-License-Identifier: BSD-3-Clause
// Selects the pairs that a calibration uses.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calib/solve/subset_solver.h"

namespace stereod::calib {

/// A pair is an outlier if its error exceeds this multiple of the median error, and a floor.
inline constexpr double kOutlierFactor = 3;

/// Narrows the pairs of one SolveResult down to the consistent ones, and records there why each other pair was
/// rejected. Every step throws CalibrationError if fewer than kMinPairs are left.
class PairSelection {
 public:
  /// @p result and @p solver must outlive the object.
  PairSelection(SolveResult& result, const SubsetSolver& solver) : result_(result), solver_(solver) {}

  /// Copies the boards of @p searches into the result, and selects the pairs that show a sharp board and are not
  /// repeated.
  void select_usable(const std::vector<ImagePair>& images, const std::vector<PairSearch>& searches);

  /// Solves for each camera alone and rejects bent boards, then pairs off the consensus relative pose, then pairs
  /// that repeat the left image of a better pair.
  void reject_outliers();

  /// Rejects the selected pair at @p position in selected(): its board moved between the two images.
  void reject_moved(std::size_t position, double error_px);

  /// Returns the pairs selected by select_usable().
  const PairIndices& usable() const { return usable_; }
  /// Returns the pairs that are still selected.
  const PairIndices& selected() const { return selected_; }

 private:
  void reject(std::size_t index, std::string reason);
  void reject_above(double limit_px, const std::vector<double>& errors_px, std::string (*reason)(double));
  void reject_if_repeated(std::size_t index);
  void reject_bent(const CameraModel& camera, Side side);
  void reject_repeated_left();
  void require_enough() const;

  SolveResult& result_;
  const SubsetSolver& solver_;
  PairIndices usable_, selected_;
};

}  // namespace stereod::calib
