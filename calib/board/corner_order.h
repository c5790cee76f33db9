// SPDX-License-Identifier: BSD-3-Clause
// Brings the corners of a chessboard into a fixed order.
#pragma once

#include <optional>

#include "calib/board/board.h"
#include "core/base/image.h"

namespace stereod::calib {

/// Returns @p corners, which a finder may list in any orientation of the board, in board order: seen from the
/// front, rows follow columns clockwise. Unless the board is ambiguous, the square inside the first four
/// corners is dark. All corners must lie within @p image.
Corners in_board_order(GrayView image, const Board& board, Corners corners);

/// Returns @p corners of an ambiguous board in the turn that matches @p reference, the same board in the other
/// camera. Assumes that both cameras are the same way up, so that the first row points in about the same
/// direction in both images. Returns nothing if no turn matches within 60°, or 30° for a square board.
/// Returns the corners of an unambiguous board unchanged.
std::optional<Corners> turned_like(const Corners& reference, const Board& board, const Corners& corners);

/// Returns @p corners after half a turn of the board.
Corners half_turned(Corners corners);

}  // namespace stereod::calib
