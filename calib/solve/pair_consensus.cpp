#include "calib/solve/pair_consensus.h"

#include <algorithm>
#include <limits>

namespace stereod {

namespace {

// From the left camera's view to the right image and the other way round; the worse of the two.
double transfer_error_px(const StereoRigEstimate& cameras, const StereoPose& pose, const Board& board,
                         const PosedPair& pair) {
  const double to_right =
      board_error_px(cameras.right, board, seen_from_right(pose, pair.in_left), pair.corners.right);
  const Matrix3 back = transposed(pose.rotation);
  const Vector3 shift = back * pose.translation_m;
  const StereoPose to_the_left{back, {-shift.x, -shift.y, -shift.z}};
  const double to_left =
      board_error_px(cameras.left, board, seen_from_right(to_the_left, pair.in_right), pair.corners.left);
  return std::max(to_right, to_left);
}

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> disagreement_px(const StereoRigEstimate& cameras, const Board& board,
                                    std::span<const PosedPair> pairs) {
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (const PosedPair& candidate : pairs) {
    const StereoPose pose = relative_pose(candidate.in_left, candidate.in_right);
    std::vector<double> errors;
    for (const PosedPair& pair : pairs) errors.push_back(transfer_error_px(cameras, pose, board, pair));
    const double middle = median(errors);
    if (middle < least || best.empty()) {
      least = middle;
      best = std::move(errors);
    }
  }
  return best;
}

std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t from) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < count; ++i) places.push_back((2 * i + 1) * from / (2 * count));
  return places;
}

}  // namespace stereod
