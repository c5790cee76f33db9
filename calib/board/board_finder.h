// Finding a chessboard in a image.
#pragma once

#include <optional>

#include "calib/board/board.h"
#include "core/base/image.h"

namespace stereod {

struct FoundBoard {
  Corners corners;           ///< in board order, to a few hundredths of a pixel
  double edge_width_px = 0;  ///< of the squares' edges, from dark to light: about 2 where sharp
};

enum class Effort {
  kThorough,  ///< seconds, if need be, for images that are there for good
  kLive,      ///< milliseconds: the next frame is another chance
};

/// The whole board or nothing.
std::optional<FoundBoard> find_board(GrayView picture, const Board& board, Effort effort);

/// The largest chessboard of at least 3×3 inner corners, its square 0; nothing if there is none.
std::optional<Board> find_any_board(GrayView picture);

}  // namespace stereod
