// Points of one rectified picture found again in the other, without any board.
#pragma once

#include <vector>

#include "core/image.h"
#include "core/misalignment.h"

namespace stereod {

/// Well-textured points of the left picture, searched for in the right one some rows up and down (a fortieth
/// of the height, at least 6), a quarter of the width to the left and a little to the right, and back again.
std::vector<RowMatch> match_rows(GreyView left, GreyView right);

}  // namespace stereod
