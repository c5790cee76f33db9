// From images of a board to a calibration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/board/board.h"
#include "calib/board/board_search.h"
#include "calib/solve/camera_solver.h"
#include "calib/solve/pair_geometry.h"

namespace stereod {

enum class PairFate {
  kUsed,     ///< calibrated with; checked by a calibration that it had no part in
  kLeftOut,  ///< for a reason
};

/// What became of one pair.
struct PairResult {
  std::string name;
  PairFate fate = PairFate::kLeftOut;
  std::string reason;      ///< why it was left out
  bool disagrees = false;  ///< with the others, or with a flat board, and so left out
  BoardPair corners;       ///< empty lists where no board was found
  double error_px = 0;     ///< root mean square distance of corners from where they belong
  PairCheck check;         ///< while it was held back; not for pairs left out
};

struct SolveResult {
  Board board;
  LensChoice lens = LensChoice::kPinhole;
  Calibration calibration;
  double left_rms_px = 0, right_rms_px = 0;  ///< each camera for itself
  PairCheck held_back;                       ///< mean over the pairs, each while it was held back
  double max_epipolar_error_px = 0;          ///< of such a pair
  std::optional<double> matched_error_px;    ///< MatchedBoards, on the same; nothing: too few points
  std::vector<PairResult> pairs;             ///< in the order given

  int count(PairFate fate) const;
};

struct SolveOptions {
  std::optional<Board> board;  ///< its square is not looked at; nothing: found out from the images
  double square_m = 0;
  LensChoice lens = LensChoice::kPinhole;
};

inline constexpr int kMinPairs = 5;
inline constexpr std::size_t kHeldBackGroups = 5;

/// Finds the board, each camera, how they stand to each other, and the pairs that do not agree. The errors
/// are those of pairs that were not calibrated with (cross-validation, Stone 1974): a fifth is held back at a
/// time and measured with a calibration from the others, until each was held back once; the calibration
/// itself is made from all good pairs. Throws CalibrationError with a sentence: no board, a board of another
/// size (which one), fewer than kMinPairs good pairs, cameras swapped or not side by side.
SolveResult solve(const std::vector<ImagePair>& pictures, const SolveOptions& options);

/// The same where the boards have been found; `options.board` is set.
SolveResult solve_found(const std::vector<ImagePair>& pictures, const std::vector<PairSearch>& found,
                        const SolveOptions& options);

}  // namespace stereod
