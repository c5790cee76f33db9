// SPDX-License-Identifier: BSD-3-Clause
// Finds a chessboard in an image.
#pragma once

#include <optional>

#include "calib/board/board.h"
#include "core/base/image.h"

namespace stereod::calib {

struct FoundBoard {
  Corners corners;           ///< in board order (in_board_order()), to a few hundredths of a pixel
  double edge_width_px = 0;  ///< edge_width_px() of the board; 0 with Effort::kLive
};

enum class Effort {
  kThorough,  ///< up to seconds per image, for images on disk
  kLive,      ///< milliseconds per image: the next frame is another chance
};

/// Returns @p board if all its corners are found in @p image.
std::optional<FoundBoard> find_board(GrayView image, const Board& board, Effort effort);

/// Returns the largest chessboard with at least 3×3 inner corners in @p image, with square_m = 0.
std::optional<Board> find_any_board(GrayView image);

}  // namespace stereod::calib
