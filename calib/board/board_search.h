// SPDX-License-Identifier: BSD-3-Clause
// Searches all images of a calibration for the board.
#pragma once

#include <string>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/board/board.h"

namespace stereod::calib {

/// The board in one image pair.
struct PairSearch {
  BoardPair corners;                           ///< a list is empty where no board was found
  double left_edge_px = 0, right_edge_px = 0;  ///< edge_width_px() of the board
  std::string problem;                         ///< why the pair has no usable board; empty if it has one
};

/// Returns the board that most of a sample of @p images show.
/// @throws CalibrationError if no sampled image shows a board.
Board guess_board(const std::vector<ImagePair>& images);

/// Searches every image for @p board, using all CPUs. Returns one entry per pair, in order.
/// @throws CalibrationError if no image shows the board, or if a sample of @p images shows a board of another
/// size, which the sentence names.
std::vector<PairSearch> search_boards(const std::vector<ImagePair>& images, const Board& board);

}  // namespace stereod::calib
