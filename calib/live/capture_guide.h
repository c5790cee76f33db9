// SPDX-License-Identifier: BSD-3-Clause
// Guides a person who moves the board in front of the cameras.
#pragma once

#include <string>
#include <vector>

#include "calib/board/board.h"
#include "calib/quality/coverage.h"

namespace stereod::calib {

/// How a board appears in an image, independent of the image size.
struct BoardView {
  double x = 0, y = 0;  ///< center, 0…1
  double size = 0;      ///< square root of the board's share of the image area, 0…1
  double lean_x = 0;    ///< ln(height of the left side / height of the right side); 0.1 is about 10 %
  double lean_y = 0;    ///< ln(width of the upper side / width of the lower side)
};
BoardView board_view(const Board& board, const Corners& corners, Size image);

/// Returns how different two views are: the sum of the differences of all five values.
double difference(const BoardView& a, const BoardView& b);

/// Decides which pairs to take and what the person should do next.
class CaptureGuide {
 public:
  /// @p wanted: number of pairs that completes the capture if the coverage is sufficient.
  CaptureGuide(const Board& board, Size image, int wanted);

  struct Instruction {
    bool take = false;      ///< keep this pair: the board is still and the view is new; it counts as taken
    bool complete = false;  ///< enough pairs were taken
    bool left_seen = false, right_seen = false;
    std::string words;  ///< what to do next, one short imperative sentence
  };
  /// Observes one pair of frames. An empty list: the board was not found in that image.
  Instruction observe(const Corners& left, const Corners& right);

  int taken() const { return static_cast<int>(views_.size()); }
  int wanted() const { return wanted_; }
  const Coverage& left_coverage() const { return left_; }
  const Coverage& right_coverage() const { return right_; }

 private:
  bool is_still(const Corners& left, const Corners& right);
  bool is_new(const BoardView& view) const;
  void keep(const BoardView& view, const Corners& left, const Corners& right);
  bool complete() const;
  std::string next_goal(const BoardView& now) const;

  Board board_;
  Size image_;
  int wanted_;
  Coverage left_, right_;
  std::vector<BoardView> views_;
  Corners last_left_, last_right_;
  int still_frames_ = 0;
};

}  // namespace stereod::calib
