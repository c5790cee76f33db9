// From pictures of a board to a calibration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/board.h"
#include "calib/camera_solver.h"
#include "calib/pair_geometry.h"
#include "calib/pair_input.h"

namespace stereod {

enum class PairFate {
  kUsed,      ///< calibrated with
  kHeldBack,  ///< checked with
  kLeftOut,   ///< for a reason
};

/// What became of one pair.
struct PairResult {
  std::string name;
  PairFate fate = PairFate::kLeftOut;
  std::string reason;   ///< why it was left out
  BoardPair corners;    ///< empty lists where no board was found
  double error_px = 0;  ///< root mean square distance of corners from where they belong
  PairCheck check;      ///< after the calibration; not for pairs left out
};

struct SolveResult {
  Board board;
  LensChoice lens = LensChoice::kPinhole;
  Calibration calibration;
  double left_rms_px = 0, right_rms_px = 0;  ///< each camera for itself
  PairCheck held_back;                       ///< mean over the pairs held back; the worst scale error
  double worst_row_error_px = 0;             ///< of a pair held back
  std::optional<double> matched_error_px;  ///< MatchedBoards, on the pairs held back; nothing: too few points
  std::vector<PairResult> pairs;           ///< in the order given

  int count(PairFate fate) const;
};

struct SolveOptions {
  std::optional<Board> board;  ///< its square is not looked at; nothing: found out from the pictures
  double square_m = 0;
  LensChoice lens = LensChoice::kPinhole;
};

inline constexpr int kFewestPairs = 5;

/// Finds the board, each camera, how they stand to each other, and the pairs that do not agree; a fifth of
/// the good pairs is held back to check with. Throws CalibrationError with a sentence: no board, a board of
/// another size (which one), fewer than kFewestPairs good pairs, cameras swapped or not side by side.
SolveResult solve(const std::vector<PicturePair>& pictures, const SolveOptions& options);

}  // namespace stereod
