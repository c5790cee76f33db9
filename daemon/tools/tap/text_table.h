// SPDX-License-Identifier: BSD-3-Clause
// Text in columns for the terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/base/text.h"

namespace stereod::tools {

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
