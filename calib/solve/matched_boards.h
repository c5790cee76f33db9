// SPDX-License-Identifier: BSD-3-Clause
// Measures the matcher's disparity error on boards.
#pragma once

#include <cstddef>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/board/board.h"
#include "calib/solve/board_pose.h"
#include "core/geometry/calibration.h"

namespace stereod::calib {

/// Collects the disparity errors of the daemon's matcher on held-out pairs. The reference is a flat board of the
/// true size in the best pose, so that the errors include calibration, lens, noise, blur and matcher.
class MatchedBoards {
 public:
  /// @p board must outlive the object.
  explicit MatchedBoards(const Board& board) : board_(board) {}

  /// Rectifies and matches @p pair with the daemon's default settings. @p in_left is the board's pose for the
  /// left camera.
  void add(const Calibration& calibration, const ImagePair& pair, const BoardPose& in_left);

  /// Returns the number of disparities measured.
  std::size_t points() const { return errors_px_.size(); }

  /// Returns the error [px] that 68 % of the points stay below: one standard deviation of a normal
  /// distribution. Requires points() > 0.
  double deviation_px() const;

 private:
  const Board& board_;
  std::vector<float> errors_px_;
};

}  // namespace stereod::calib
