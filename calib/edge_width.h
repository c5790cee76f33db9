// How sharp a picture of a board is.
#pragma once

#include "calib/board.h"
#include "core/image.h"

namespace stereod {

/// How many pixels the squares' edges take to get from 10 to 90 % of their step, the median over all edges of
/// the direction that is blurred more. About 2 where sharp; never more than a square's side.
double edge_width_px(GreyView picture, const Board& board, const Corners& corners);

}  // namespace stereod
