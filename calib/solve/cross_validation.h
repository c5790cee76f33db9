// SPDX-License-Identifier: BSD-3-Clause
// K-fold cross-validation of a calibration.
#pragma once

#include <vector>

#include "calib/base/pair_input.h"
#include "calib/solve/pair_selection.h"
#include "calib/solve/subset_solver.h"

namespace stereod::calib {

/// Holds out each fold of the selected pairs in turn, solves from the other pairs starting at @p cameras, and
/// measures the result on the held-out pairs. Writes PairResult::check of each pair, the mean errors and the
/// epipolar error in the calibration's quality to @p result.
/// @throws CalibrationError if the pairs outside one fold have no solution.
void cross_validate(SolveResult& result, const SubsetSolver& solver, const PairSelection& selection,
                    const StereoRigEstimate& cameras, const std::vector<ImagePair>& images);

}  // namespace stereod::calib
