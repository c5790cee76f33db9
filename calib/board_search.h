// Boards in all the pictures of a session.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/board_finder.h"
#include "calib/pair_geometry.h"
#include "calib/pair_input.h"

namespace stereod {

/// One pair's boards, or why there are none.
struct PairSearch {
  BoardPair corners;  ///< same corner, same place; empty lists where not found
  double left_edge_px = 0, right_edge_px = 0;
  std::string problem;  ///< empty: found in both and matched up
};

/// The board that most of some pictures show. Throws CalibrationError if none shows any.
Board guess_board(const std::vector<PicturePair>& pictures);

/// Looks for `board` in every picture, on all CPUs. Throws CalibrationError if no picture shows it, or if
/// some pictures, looked at first, show a board of another size, which it names.
std::vector<PairSearch> search_boards(const std::vector<PicturePair>& pictures, const Board& board);

}  // namespace stereod
