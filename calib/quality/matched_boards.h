// How exact the matcher's disparities are with a calibration, measured on boards.
#pragma once

#include <cstddef>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/solve/pair_geometry.h"

namespace stereod {

/// Collects, over pairs that were not calibrated with, how far the disparities of the daemon's matcher are
/// from those of a plane board of the true size in the best pose. So the errors of calibration and matcher
/// are in it together, for these cameras with their noise, their blur and the way they are exposed.
class MatchedBoards {
 public:
  explicit MatchedBoards(const Board& board) : board_(board) {}

  /// Rectifies and matches the pair as the daemon does by default. `in_left`: the board's pose for the left
  /// camera.
  void add(const Calibration& calibration, const ImagePair& pair, const BoardPose& in_left);

  std::size_t points() const { return errors_px_.size(); }
  /// What two thirds (68 %) of the points are nearer than: one standard deviation, if it were a normal
  /// distribution. There is at least one point.
  double deviation_px() const;

 private:
  const Board& board_;
  std::vector<float> errors_px_;
};

}  // namespace stereod
