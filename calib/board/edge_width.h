// SPDX-License-Identifier: BSD-3-Clause
// Measures how sharp an image of a board is.
#pragma once

#include "calib/board/board.h"
#include "core/base/image.h"

namespace stereod::calib {

/// Returns the width [px] over which the edges of the squares rise from 10 to 90 % of their step: the median
/// over all edges of the more blurred direction. About 2 in a sharp image, at most the side of a square.
double edge_width_px(GrayView image, const Board& board, const Corners& corners);

/// Returns the edge width [px] above which an image of size @p image is too blurred to calibrate with:
/// 3.7 at 320×240, 6 at 640×480, 11.2 at 1280×720. Sampling alone makes an edge 2.5 px wide. Defocus and motion
/// blur cover a fixed angle, hence a number of pixels that grows with the resolution.
double blur_limit_px(Size image);

}  // namespace stereod::calib
