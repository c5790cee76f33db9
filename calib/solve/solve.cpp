// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/solve.h"

#include <algorithm>
#include <cmath>

#include "calib/base/errors.h"
#include "calib/base/statistics.h"
#include "calib/base/text.h"
#include "calib/solve/cross_validation.h"
#include "calib/solve/pair_selection.h"
#include "calib/solve/subset_solver.h"
#include "daemon/base/progress.h"

namespace stereod::calib {

namespace {

// Outliers below this error are kept once both cameras are solved together.
constexpr double kMinOutlierError_px = 0.6;

// Solves for both cameras from the selected pairs and writes the reprojection errors to @p result.
StereoSolution solve_selected(SolveResult& result, const SubsetSolver& solver, const PairIndices& selected) {
  const CameraSolution left = solver.camera(selected, Side::kLeft);
  const CameraSolution right = solver.camera(selected, Side::kRight);
  result.left_rms_px = left.rms_px, result.right_rms_px = right.rms_px;
  return solver.rig(selected, left.camera, right.camera);
}

// Solves, and solves again without the worst pair while it is an outlier.
StereoSolution solve_without_outliers(SolveResult& result, const SubsetSolver& solver,
                                      PairSelection& selection) {
  for (;;) {
    StereoSolution solution = solve_selected(result, solver, selection.selected());
    std::vector<double> errors;
    for (const std::size_t i : selection.selected()) {
      PairResult& pair = result.pairs[i];
      pair.error_px =
          pair_error_px(solution.cameras, result.board, pair.corners, solver.pose(solution.cameras, i));
      errors.push_back(pair.error_px);
    }
    const double limit = std::max(kOutlierFactor * median(errors), kMinOutlierError_px);
    const auto worst = std::max_element(errors.begin(), errors.end());
    if (!(*worst > limit) || errors.size() < kMinPairs) return solution;
    selection.reject_moved(static_cast<std::size_t>(worst - errors.begin()), *worst);
  }
}

void require_two_cameras(const StereoRigEstimate& cameras, const Board& board) {
  const Vector3& t = cameras.pose.translation_m;
  const double distance_m = std::hypot(t.x, t.y, t.z);
  if (distance_m > board.square_m / 10) return;
  throw CalibrationError("left and right are images of one camera (camera positions " +
                         fixed(1000 * distance_m, 2) +
                         " mm apart); give the left camera's images as left and the right camera's as right");
}

}  // namespace

int SolveResult::count(PairOutcome outcome) const {
  return static_cast<int>(
      std::count_if(pairs.begin(), pairs.end(), [&](const PairResult& p) { return p.outcome == outcome; }));
}

SolveResult solve(const std::vector<ImagePair>& images, const SolveOptions& options) {
  if (images.size() < kMinPairs) {
    throw CalibrationError("found " + std::to_string(images.size()) +
                           (images.size() == 1 ? " pair" : " pairs") + " of images; at least " +
                           std::to_string(kMinPairs) + " are needed, 15 or more are better");
  }
  SolveOptions with_board = options;
  if (!with_board.board) with_board.board = guess_board(images);
  return solve_found(images, search_boards(images, *with_board.board), with_board);
}

SolveResult solve_found(const std::vector<ImagePair>& images, const std::vector<PairSearch>& found,
                        const SolveOptions& options) {
  SolveResult result;
  result.lens = options.lens;
  result.board = options.board.value();
  result.board.square_m = options.square_m;
  const SubsetSolver solver(result, images.front().left.size());
  PairSelection selection(result, solver);
  selection.select_usable(images, found);
  Progress progress("calibrating", 3);
  selection.reject_outliers();
  progress.step();
  const StereoSolution solution = solve_without_outliers(result, solver, selection);
  for (const std::size_t i : selection.selected()) result.pairs[i].outcome = PairOutcome::kUsed;
  require_two_cameras(solution.cameras, result.board);
  result.calibration = rectified(solution.cameras);
  result.calibration.quality.pairs_used = static_cast<int>(selection.selected().size());
  result.calibration.quality.rms_px = solution.rms_px;
  progress.step();
  cross_validate(result, solver, selection, solution.cameras, images);
  progress.step();
  return result;
}

}  // namespace stereod::calib
