// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/cross_validation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/solve/matched_boards.h"

namespace stereod::calib {

namespace {

// Returns the fold of each selected pair. It follows from the pair's position among the usable pairs, so that
// rejecting one pair moves no other pair to another fold. If one fold would then hold more than half of the
// selected pairs, it follows from the position among the selected pairs.
std::vector<std::size_t> folds_of(const PairSelection& selection) {
  const PairIndices &usable = selection.usable(), &selected = selection.selected();
  std::vector<std::size_t> folds;
  std::array<std::size_t, kFolds> sizes{};
  for (const std::size_t i : selected) {
    const auto position = std::find(usable.begin(), usable.end(), i) - usable.begin();
    folds.push_back(static_cast<std::size_t>(position) % kFolds);
    ++sizes[folds.back()];
  }
  if (2 * *std::max_element(sizes.begin(), sizes.end()) > selected.size()) {
    for (std::size_t position = 0; position < folds.size(); ++position) folds[position] = position % kFolds;
  }
  return folds;
}

void write_means(SolveResult& result, const PairIndices& selected) {
  PairCheck& mean = result.held_out;
  const auto count = static_cast<double>(selected.size());
  for (const std::size_t i : selected) {
    const PairCheck& one = result.pairs[i].check;
    mean.epipolar_error_px += one.epipolar_error_px / count;
    mean.row_offset_px += one.row_offset_px / count;
    mean.disparity_error_px += one.disparity_error_px * one.disparity_error_px / count;
    mean.scale_error += one.scale_error / count;
    result.max_epipolar_error_px = std::max(result.max_epipolar_error_px, one.epipolar_error_px);
  }
  mean.disparity_error_px = std::sqrt(mean.disparity_error_px);
  result.calibration.quality.epipolar_error_px = mean.epipolar_error_px;
}

}  // namespace

void cross_validate(SolveResult& result, const SubsetSolver& solver, const PairSelection& selection,
                    const StereoRigEstimate& cameras, const std::vector<ImagePair>& images) {
  MatchedBoards matched(result.board);
  const PairIndices& selected = selection.selected();
  const std::vector<std::size_t> folds = folds_of(selection);
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    PairIndices held_out, others;
    for (std::size_t position = 0; position < selected.size(); ++position) {
      (folds[position] == fold ? held_out : others).push_back(selected[position]);
    }
    if (held_out.empty()) continue;
    // The solution does not depend on the start; starting at the solution for all pairs takes few iterations.
    const StereoRigEstimate fold_cameras = solver.rig(others, cameras.left, cameras.right).cameras;
    const Calibration calibration = rectified(fold_cameras);
    for (const std::size_t i : held_out) {
      PairResult& pair = result.pairs[i];
      const BoardPose pose = solver.pose(fold_cameras, i);
      pair.check = check_pair(calibration, result.board, pair.corners, pose);
      matched.add(calibration, images[i], pose);
    }
  }
  write_means(result, selected);
  constexpr std::size_t kMinPoints = 500;
  if (matched.points() >= kMinPoints) result.matched_error_px = matched.deviation_px();
}

}  // namespace stereod::calib
