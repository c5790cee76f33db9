// SPDX-License-Identifier: BSD-3-Clause
#include "calib/board/board.h"

#include <charconv>
#include <string>

#include "calib/base/errors.h"

namespace stereod::calib {

namespace {

constexpr int kMinCorners = 3, kMaxCorners = 50;

}  // namespace

Board parse_board(std::string_view text) {
  std::string plain(text);
  if (const auto at = plain.find("×"); at != std::string::npos) plain.replace(at, 2, "x");
  Board board;
  const char* const end = plain.data() + plain.size();
  const auto columns = std::from_chars(plain.data(), end, board.columns);
  if (columns.ec == std::errc() && columns.ptr != end && (*columns.ptr == 'x' || *columns.ptr == 'X')) {
    const auto rows = std::from_chars(columns.ptr + 1, end, board.rows);
    const auto fits = [](int count) { return count >= kMinCorners && count <= kMaxCorners; };
    if (rows.ec == std::errc() && rows.ptr == end && fits(board.columns) && fits(board.rows)) return board;
  }
  throw UsageError("--board: found '" + plain +
                   "', allowed are inner corners across and down, like 9x6 (3…50 each), or auto");
}

double parse_length(std::string_view text, const std::string& option) {
  struct Unit {
    std::string_view name;
    double meters;
  };
  constexpr Unit kUnits[] = {{"mm", 1e-3}, {"cm", 1e-2}, {"in", 0.0254}, {"m", 1}};
  double number = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  if (parsed.ec == std::errc()) {
    std::string_view unit = text.substr(static_cast<std::size_t>(parsed.ptr - text.data()));
    while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
    for (const Unit& known : kUnits) {
      // Division: 0.001 is not representable, so that a product would be off by a rounding step.
      const double meters = known.meters == 1e-3   ? number / 1000
                            : known.meters == 1e-2 ? number / 100
                                                   : number * known.meters;
      if (unit == known.name && meters >= 1e-3 && meters <= 10) return meters;
    }
  }
  throw UsageError(option + ": found '" + std::string(text) +
                   "', allowed is a length with its unit, like 25mm, 2.5cm, 0.025m or 1in (1mm…10m)");
}

std::string to_string(const Board& board) {
  return std::to_string(board.columns) + "×" + std::to_string(board.rows) + " inner corners";
}

Vector3 board_point(const Board& board, std::size_t index) {
  const auto columns = static_cast<std::size_t>(board.columns);
  const std::size_t column = index % columns, row = index / columns;
  return {static_cast<double>(column) * board.square_m, static_cast<double>(row) * board.square_m, 0};
}

}  // namespace stereod::calib
