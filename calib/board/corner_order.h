// Which corner of a chessboard is which.
#pragma once

#include <optional>

#include "calib/board/board.h"
#include "core/base/image.h"

namespace stereod {

/// Puts corners that a finder listed in any of the board's orientations into a fixed one: rows run clockwise
/// from columns, as seen from the front, and, where the board is not ambiguous, the square inside the first
/// four corners is dark. All corners lie within the image.
Corners in_board_order(GrayView picture, const Board& board, Corners corners);

/// `corners` of an ambiguous board turned the way that fits `reference`, the same board in the other camera,
/// best: both cameras are the same way up, so the first row points about the same way in both. Other boards
/// come back as they are. Nothing if none fits to 60°, or to 30° for a board with as many rows as columns.
std::optional<Corners> turned_like(const Corners& reference, const Board& board, const Corners& corners);

/// The corners after half a turn of the board.
Corners half_turned(Corners corners);

}  // namespace stereod
