// How sharp a image of a board is.
#pragma once

#include "calib/board/board.h"
#include "core/base/image.h"

namespace stereod {

/// How many pixels the squares' edges take to get from 10 to 90 % of their step, the median over all edges of
/// the direction that is blurred more. About 2 where sharp; never more than a square's side.
double edge_width_px(GrayView picture, const Board& board, const Corners& corners);

/// Above which a image of this size is too blurred to calibrate with: 3.7 px at 320×240, 6 at 640×480, 11.2
/// at 1280×720. Pixels alone make an edge 2.5 px wide; what a lens out of focus or a moving board adds is an
/// angle, so more pixels the more of them there are.
double blur_limit_px(Size image);

}  // namespace stereod
