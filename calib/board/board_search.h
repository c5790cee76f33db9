// Boards in all the images of a session.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/board/board_finder.h"
#include "calib/solve/pair_geometry.h"

namespace stereod {

/// One pair's boards, or why there are none.
struct PairSearch {
  BoardPair corners;  ///< same corner, same place; empty lists where not found
  double left_edge_px = 0, right_edge_px = 0;
  std::string problem;  ///< empty: found in both and matched up
};

/// The board that most of some images show. Throws CalibrationError if none shows any.
Board guess_board(const std::vector<ImagePair>& pictures);

/// Looks for `board` in every image, on all CPUs. Throws CalibrationError if no image shows it, or if
/// some images, looked at first, show a board of another size, which it names.
std::vector<PairSearch> search_boards(const std::vector<ImagePair>& pictures, const Board& board);

}  // namespace stereod
