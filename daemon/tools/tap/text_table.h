// SPDX-License-Identifier: BSD-3-Clause
// Text in columns for the terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace stereod::tools {

/// `text` from the network made fit for a terminal: control characters (escape sequences among them) and
/// bytes that are not UTF-8 become '?'.
std::string printable(std::string_view text);

/// Columns that a terminal needs for printable text: one for each character.
std::size_t display_width(std::string_view text);

/// A number with so many digits after the point, or "-" if it is none.
std::string fixed(double value, int digits);

/// `text` broken at spaces into lines of up to `width` columns; a word longer than that is cut. At least one
/// line.
std::vector<std::string> wrapped(std::string_view text, std::size_t width);

/// Rows of cells, each column as wide as its widest cell, two spaces between. Cells are wrapped at a column's
/// greatest width.
class TextTable {
 public:
  enum class Align { kLeft, kRight };
  struct Column {
    Align align = Align::kLeft;
    std::size_t min_width = 0;
    std::size_t max_width = 1000;
  };

  explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// One cell for each column; missing ones are empty.
  void add_row(std::vector<std::string> cells);

  /// The lines of the table, without trailing spaces.
  std::vector<std::string> lines() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::vector<std::string>>> rows_;  // row, column, line in the cell
};

}  // namespace stereod::tools
