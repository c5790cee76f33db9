// The chessboard that cameras are calibrated with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/camera_model.h"

namespace stereod {

/// A chessboard, told by its inner corners: those where four squares meet. 9×6 is ten squares by seven.
struct Board {
  int columns = 0, rows = 0;  ///< inner corners, ≥ 3
  double square_m = 0;        ///< side of a square, meters

  std::size_t corner_count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  /// Looks the same after half a turn: both counts even or both odd.
  bool ambiguous() const { return (columns + rows) % 2 == 0; }
  friend bool operator==(const Board&, const Board&) = default;
};

/// The corners of a board in an image, pixels, row by row; as many as the board has.
using Corners = std::vector<Point2>;

/// "9x6" (or "9×6") as inner corners, 3 to 50 each; the square is left 0. Throws UsageError.
Board parse_board(std::string_view text);

/// A length with its unit: "25mm", "2.5cm", "0.025m", "1in"; from 1 mm to 10 m. In meters.
/// Throws UsageError, beginning with `option`.
double parse_length(std::string_view text, const std::string& option);

/// "9×6 inner corners".
std::string in_words(const Board& board);

/// Where the board's corner `index` is in the plane z = 0, meters; the first is the origin.
Vector3 board_point(const Board& board, std::size_t index);

}  // namespace stereod
