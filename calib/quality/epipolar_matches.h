// SPDX-License-Identifier: BSD-3-Clause
// Matches points between rectified images without a board.
#pragma once

#include <vector>

#include "core/base/image.h"
#include "core/perception/epipolar_error.h"

namespace stereod::calib {

/// Matches textured points of the rectified @p left image in the rectified @p right one. The search covers 1/40 of
/// the image height (at least 6 rows) up and down, 1/4 of the width to the left and 8 px to the right. A match is
/// kept if the search in the opposite direction returns to its start.
std::vector<EpipolarMatch> match_epipolar_points(GrayView left, GrayView right);

}  // namespace stereod::calib
