// SPDX-License-Identifier: BSD-3-Clause
#include "calib/board/corner_order.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stereod::calib {

namespace {

// A corner list as a grid.
struct Grid {
  const Corners& corners;
  int columns;

  const Point2& at(int column, int row) const {
    return corners[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
  }
};

Point2 minus(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }

Point2 row_direction(const Corners& corners, const Board& board) {
  return minus(corners[static_cast<std::size_t>(board.columns) - 1], corners.front());
}

// Returns whether the list runs counterclockwise: the board as a mirror shows it.
bool is_mirrored(const Corners& corners, const Board& board) {
  const Grid grid{corners, board.columns};
  const int right = board.columns - 1, bottom = board.rows - 1;
  const Point2 diagonal = minus(grid.at(right, bottom), grid.at(0, 0));
  const Point2 antidiagonal = minus(grid.at(0, bottom), grid.at(right, 0));
  return cross(diagonal, antidiagonal) < 0;
}

Corners mirrored(const Corners& corners, const Board& board) {
  Corners result = corners;
  const auto columns = static_cast<std::ptrdiff_t>(board.columns);
  for (std::ptrdiff_t row = 0; row < board.rows; ++row) {
    std::reverse(result.begin() + row * columns, result.begin() + (row + 1) * columns);
  }
  return result;
}

double gray_at(GrayView image, double x, double y) {
  const int column = std::clamp(static_cast<int>(std::lround(x)), 0, image.width() - 1);
  const int row = std::clamp(static_cast<int>(std::lround(y)), 0, image.height() - 1);
  return image.at(column, row);
}

// Returns the mean brightness of the squares with the first square's color, minus that of the other squares.
double first_square_contrast(GrayView image, const Board& board, const Corners& corners) {
  const Grid grid{corners, board.columns};
  double sum[2] = {0, 0}, count[2] = {0, 0};
  for (int row = 0; row + 1 < board.rows; ++row) {
    for (int column = 0; column + 1 < board.columns; ++column) {
      const Point2 a = grid.at(column, row), b = grid.at(column + 1, row + 1);
      const Point2 c = grid.at(column + 1, row), d = grid.at(column, row + 1);
      const int color = (row + column) % 2;
      sum[color] += gray_at(image, (a.x + b.x + c.x + d.x) / 4, (a.y + b.y + c.y + d.y) / 4);
      count[color] += 1;
    }
  }
  return sum[0] / count[0] - sum[1] / count[1];
}

// Returns the corners of a square board after a quarter turn.
Corners quarter_turned(const Corners& corners, int side) {
  const Grid grid{corners, side};
  Corners result;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) result.push_back(grid.at(row, side - 1 - column));
  }
  return result;
}

double angle_between(Point2 a, Point2 b) { return std::abs(std::atan2(cross(a, b), a.x * b.x + a.y * b.y)); }

}  // namespace

Corners half_turned(Corners corners) {
  std::reverse(corners.begin(), corners.end());
  return corners;
}

Corners in_board_order(GrayView image, const Board& board, Corners corners) {
  if (is_mirrored(corners, board)) corners = mirrored(corners, board);
  if (!board.ambiguous() && first_square_contrast(image, board, corners) > 0) {
    corners = half_turned(std::move(corners));
  }
  return corners;
}

std::optional<Corners> turned_like(const Corners& reference, const Board& board, const Corners& corners) {
  if (!board.ambiguous()) return corners;
  std::vector<Corners> candidates{corners, half_turned(corners)};
  const bool square = board.columns == board.rows;
  if (square) {
    candidates.push_back(quarter_turned(candidates[0], board.columns));
    candidates.push_back(quarter_turned(candidates[1], board.columns));
  }
  const auto turn = [&](const Corners& c) {
    return angle_between(row_direction(reference, board), row_direction(c, board));
  };
  const auto best = std::min_element(candidates.begin(), candidates.end(),
                                     [&](const Corners& a, const Corners& b) { return turn(a) < turn(b); });
  const double max_turn = (square ? 30.0 : 60.0) * std::numbers::pi / 180;
  if (turn(*best) > max_turn) return std::nullopt;
  return *best;
}

}  // namespace stereod::calib
