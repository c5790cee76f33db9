// What a person before the cameras should do next.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/board/board.h"
#include "calib/quality/coverage.h"
#include "calib/solve/pair_geometry.h"

namespace stereod {

/// How a board looks in an image, in numbers that do not depend on the image's size.
struct View {
  double x = 0, y = 0;  ///< its middle, 0 … 1
  double size = 0;      ///< root of its share of the image's area, 0 … 1
  double lean_x = 0;    ///< how much taller its left side looks than its right one; 0.1 is a tenth
  double lean_y = 0;    ///< how much wider its upper side looks than its lower one
};
View view_of(const Board& board, const Corners& corners, Size image);

/// How different two views are; 0.1 is a step aside of a tenth of the image.
double difference(const View& a, const View& b);

/// Decides which pairs are taken and what to say. Frames come in by observe().
class CaptureGuide {
 public:
  /// `wanted`: how many pairs make it complete, provided that the goals are met.
  CaptureGuide(const Board& board, Size image, int wanted);

  struct Instruction {
    bool take = false;      ///< this pair is still and new: keep it (it counts as taken)
    bool complete = false;  ///< enough has been taken
    bool left_seen = false, right_seen = false;
    std::string words;  ///< one short sentence in the imperative
  };
  /// The board in one pair of frames, an empty list where it was not found.
  Instruction observe(const Corners& left, const Corners& right);

  int taken() const { return static_cast<int>(views_.size()); }
  int wanted() const { return wanted_; }
  const Coverage& left_coverage() const { return left_; }
  const Coverage& right_coverage() const { return right_; }

 private:
  bool is_still(const Corners& left, const Corners& right);
  bool is_new(const View& view) const;
  void keep(const View& view, const Corners& left, const Corners& right);
  bool complete() const;
  std::string next_goal(const View& now) const;

  Board board_;
  Size image_;
  int wanted_;
  Coverage left_, right_;
  std::vector<View> views_;
  Corners last_left_, last_right_;
  int still_frames_ = 0;
};

}  // namespace stereod
