// SPDX-License-Identifier: BSD-3-Clause
#include "calib/live/capture_guide.h"

#include <algorithm>
#include <cmath>

namespace stereod::calib {

namespace {

// A board is still if its corners move less than this from frame to frame, for kStillFrames frames.
constexpr double kMaxStillMotion = 0.0016;  // share of the image width: 1 px at 640
constexpr int kStillFrames = 2;
constexpr double kMinNewDifference = 0.12;  // difference() from every view taken
constexpr double kMinLean = 0.08;
constexpr double kNearSize = 0.45, kFarSize = 0.38;
constexpr double kSufficientCoverage = 0.7;

double distance(Point2 a, Point2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

double max_motion(const Corners& before, const Corners& now) {
  double motion = 0;
  for (std::size_t i = 0; i < now.size(); ++i) motion = std::max(motion, distance(before[i], now[i]));
  return motion;
}

struct Quad {
  Point2 upper_left, upper_right, lower_left, lower_right;
};

// Returns the board's outermost corners by their position in the image, independent of the board's turn.
Quad outline(const Board& board, const Corners& corners) {
  const auto columns = static_cast<std::size_t>(board.columns);
  std::vector<Point2> outer = {corners.front(), corners[columns - 1], corners[corners.size() - columns],
                               corners.back()};
  std::sort(outer.begin(), outer.end(), [](Point2 a, Point2 b) { return a.y < b.y; });
  if (outer[0].x > outer[1].x) std::swap(outer[0], outer[1]);
  if (outer[2].x > outer[3].x) std::swap(outer[2], outer[3]);
  return {outer[0], outer[1], outer[2], outer[3]};
}

std::string missing_board_words(bool left_seen, bool right_seen) {
  if (!left_seen && !right_seen) return "show the whole board to both cameras";
  const std::string unseen = left_seen ? "right" : "left";
  return "the " + unseen + " camera does not see the whole board; move it to the " + unseen;
}

}  // namespace

BoardView board_view(const Board& board, const Corners& corners, Size image) {
  BoardView view;
  for (const Point2& p : corners) view.x += p.x, view.y += p.y;
  const auto count = static_cast<double>(corners.size());
  view.x = (view.x / count + 0.5) / image.width;
  view.y = (view.y / count + 0.5) / image.height;
  const Quad q = outline(board, corners);
  const Point2 a{q.lower_right.x - q.upper_left.x, q.lower_right.y - q.upper_left.y};
  const Point2 b{q.lower_left.x - q.upper_right.x, q.lower_left.y - q.upper_right.y};
  const double area = std::abs(a.x * b.y - a.y * b.x) / 2;
  view.size = std::sqrt(area / (static_cast<double>(image.width) * image.height));
  view.lean_x = std::log(distance(q.upper_left, q.lower_left) / distance(q.upper_right, q.lower_right));
  view.lean_y = std::log(distance(q.upper_left, q.upper_right) / distance(q.lower_left, q.lower_right));
  return view;
}

double difference(const BoardView& a, const BoardView& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.size - b.size) +
         std::abs(a.lean_x - b.lean_x) + std::abs(a.lean_y - b.lean_y);
}

CaptureGuide::CaptureGuide(const Board& board, Size image, int wanted)
    : board_(board), image_(image), wanted_(wanted), left_(image), right_(image) {}

CaptureGuide::Instruction CaptureGuide::observe(const Corners& left, const Corners& right) {
  Instruction instruction;
  instruction.left_seen = !left.empty();
  instruction.right_seen = !right.empty();
  if (!instruction.left_seen || !instruction.right_seen) {
    still_frames_ = 0;
    last_left_.clear();
    last_right_.clear();
    instruction.words = missing_board_words(instruction.left_seen, instruction.right_seen);
    return instruction;
  }
  const BoardView view = board_view(board_, left, image_);
  const bool still = is_still(left, right);
  if (!is_new(view)) {
    instruction.words = next_goal(view);
  } else if (!still) {
    instruction.words = "hold still";
  } else {
    instruction.take = true;
    keep(view, left, right);
    instruction.words = complete() ? "complete" : next_goal(view);
  }
  instruction.complete = complete();
  return instruction;
}

bool CaptureGuide::is_still(const Corners& left, const Corners& right) {
  const bool comparable = !last_left_.empty();
  const double moved =
      comparable ? std::max(max_motion(last_left_, left), max_motion(last_right_, right)) : image_.width;
  still_frames_ = moved < kMaxStillMotion * image_.width ? still_frames_ + 1 : 0;
  last_left_ = left;
  last_right_ = right;
  return still_frames_ >= kStillFrames;
}

bool CaptureGuide::is_new(const BoardView& view) const {
  return std::all_of(views_.begin(), views_.end(),
                     [&](const BoardView& taken) { return difference(taken, view) > kMinNewDifference; });
}

void CaptureGuide::keep(const BoardView& view, const Corners& left, const Corners& right) {
  views_.push_back(view);
  left_.add(left);
  right_.add(right);
  still_frames_ = 0;
}

bool CaptureGuide::complete() const {
  // Twice the wanted number is enough with any coverage.
  if (taken() >= 2 * wanted_) return true;
  return taken() >= wanted_ && std::min(left_.share(), right_.share()) >= kSufficientCoverage;
}

std::string CaptureGuide::next_goal(const BoardView& now) const {
  const auto missing = [&](auto&& has) { return std::none_of(views_.begin(), views_.end(), has); };
  if (missing([](const BoardView& v) { return v.size > kNearSize; }) && now.size <= kNearSize)
    return "come closer";
  if (missing([](const BoardView& v) { return v.lean_x > kMinLean; })) {
    return "tilt the board: its left side towards the cameras";
  }
  if (missing([](const BoardView& v) { return v.lean_x < -kMinLean; })) {
    return "tilt the board: its right side towards the cameras";
  }
  if (missing([](const BoardView& v) { return v.lean_y > kMinLean; })) {
    return "tilt the board: its upper side towards the cameras";
  }
  if (missing([](const BoardView& v) { return v.lean_y < -kMinLean; })) {
    return "tilt the board: its lower side towards the cameras";
  }
  if (missing([](const BoardView& v) { return v.size < kFarSize; }) && now.size >= kFarSize)
    return "go farther away";
  const Coverage& emptier = left_.share() <= right_.share() ? left_ : right_;
  const std::vector<std::string> empty = emptier.empty_parts();
  if (!empty.empty()) return "move the board to " + empty.front();
  return "move, turn or tilt the board a little";
}

}  // namespace stereod::calib
