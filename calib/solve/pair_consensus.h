// Which pairs were taken by cameras that stood alike.
#pragma once

#include <span>
#include <vector>

#include "calib/solve/pair_geometry.h"

namespace stereod {

/// One pair and where each camera, for itself, sees the board.
struct PosedPair {
  BoardPair corners;
  BoardPose in_left, in_right;
};

/// The error of each pair, px, under the relative pose that most pairs agree on: of the poses that single
/// pairs mean, the one with the least median error (Rousseeuw 1984). A pair whose board moved between the two
/// images stands out by far, even where such pairs are not few. `cameras.pose` is not looked at.
std::vector<double> disagreement_px(const StereoRigEstimate& cameras, const Board& board,
                                    std::span<const PosedPair> pairs);

/// The median of at least one number; of an even number of them the upper of the two in the middle.
double median(std::vector<double> values);

/// `count` of `from` places, evenly spread; count ≤ from.
std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t from);

}  // namespace stereod
