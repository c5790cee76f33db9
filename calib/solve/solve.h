// SPDX-License-Identifier: BSD-3-Clause
// Computes a calibration from images of a board.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/board/board.h"
#include "calib/board/board_search.h"
#include "calib/solve/camera_solver.h"
#include "calib/solve/pair_check.h"

namespace stereod::calib {

enum class PairOutcome {
  kUsed,      ///< part of the calibration, and held out once by cross-validation
  kRejected,  ///< not used, see PairResult::reason
};

/// The result of one pair.
struct PairResult {
  std::string name;
  PairOutcome outcome = PairOutcome::kRejected;
  std::string reason;       ///< why the pair was rejected; empty otherwise
  bool is_outlier = false;  ///< rejected because it contradicts the other pairs or a flat board
  BoardPair corners;        ///< a list is empty where no board was found
  double error_px = 0;      ///< RMS reprojection error over the corners of both images
  PairCheck check;          ///< errors while the pair was held out; only of used pairs
};

struct SolveResult {
  Board board;
  LensChoice lens = LensChoice::kPinhole;
  Calibration calibration;
  double left_rms_px = 0, right_rms_px = 0;  ///< reprojection error of each camera solved alone
  PairCheck held_out;                        ///< mean of PairResult::check over the used pairs
  double max_epipolar_error_px = 0;          ///< largest PairResult::check.epipolar_error_px
  std::optional<double>
      matched_error_px;           ///< MatchedBoards::deviation_px() on held-out pairs; nothing: < 500 points
  std::vector<PairResult> pairs;  ///< in the order given

  /// Returns the number of pairs with this outcome.
  int count(PairOutcome outcome) const;
};

struct SolveOptions {
  std::optional<Board> board;  ///< square_m is ignored; nothing: guess_board()
  double square_m = 0;         ///< side of a square [m, > 0]
  LensChoice lens = LensChoice::kPinhole;
};

inline constexpr int kMinPairs = 5;
inline constexpr std::size_t kFolds = 5;

/// Finds the board, both cameras and their relative pose, and rejects outliers. The calibration is computed from
/// all used pairs. Its errors come from k-fold cross-validation (Stone 1974) with kFolds folds: each fold in turn
/// is held out and measured with a calibration of the other pairs.
/// @throws CalibrationError with one sentence: no board, a board of another size, fewer than kMinPairs good pairs,
/// left and right swapped or not side by side.
SolveResult solve(const std::vector<ImagePair>& images, const SolveOptions& options);

/// Does the same as solve() with boards that search_boards() has found. @p options.board must be set.
SolveResult solve_found(const std::vector<ImagePair>& images, const std::vector<PairSearch>& found,
                        const SolveOptions& options);

}  // namespace stereod::calib
