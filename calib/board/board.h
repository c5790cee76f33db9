// SPDX-License-Identifier: BSD-3-Clause
// The chessboard that cameras are calibrated with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/camera_model.h"

namespace stereod::calib {

/// A chessboard, described by its inner corners, where four squares meet. 9×6 corners are 10×7 squares.
struct Board {
  int columns = 0, rows = 0;  ///< inner corners, ≥ 3
  double square_m = 0;        ///< side of a square [m]

  std::size_t corner_count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  /// Returns whether the board looks the same after half a turn: both counts are even or both are odd.
  bool ambiguous() const { return (columns + rows) % 2 == 0; }
  friend bool operator==(const Board&, const Board&) = default;
};

/// The corners of one board in an image [px], row by row. Empty or Board::corner_count() long.
using Corners = std::vector<Point2>;

/// One board seen by both cameras. Corner i is the same corner of the board in both lists.
struct BoardPair {
  Corners left, right;
};

/// Parses inner corners: "9x6" or "9×6", each count 3…50. The result has square_m = 0.
/// @throws UsageError
Board parse_board(std::string_view text);

/// Parses a length with its unit: "25mm", "2.5cm", "0.025m", "1in". Returns meters [0.001…10].
/// @throws UsageError whose sentence begins with @p option.
double parse_length(std::string_view text, const std::string& option);

/// Returns "9×6 inner corners".
std::string to_string(const Board& board);

/// Returns where corner @p index lies on the board [m]: in the plane z = 0, corner 0 at the origin.
Vector3 board_point(const Board& board, std::size_t index);

}  // namespace stereod::calib
