// Points of one rectified image found again in the other, without any board.
#pragma once

#include <vector>

#include "core/base/image.h"
#include "core/perception/epipolar_error.h"

namespace stereod {

/// Well-textured points of the left image, searched for in the right one some rows up and down (a fortieth
/// of the height, at least 6), a quarter of the width to the left and a little to the right, and back again.
std::vector<EpipolarMatch> match_rows(GrayView left, GrayView right);

}  // namespace stereod
