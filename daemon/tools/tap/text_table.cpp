// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/tap/text_table.h"

#include <algorithm>

namespace stereod::tools {
namespace {

std::string padded(const std::string& text, std::size_t width, TextTable::Align align) {
  const std::string space(width - std::min(width, display_width(text)), ' ');
  return align == TextTable::Align::kLeft ? text + space : space + text;
}

}  // namespace

void TextTable::add_row(std::vector<std::string> cells) {
  cells.resize(columns_.size());
  std::vector<std::vector<std::string>> row;
  for (std::size_t i = 0; i < cells.size(); ++i) row.push_back(wrapped(cells[i], columns_[i].max_width));
  rows_.push_back(std::move(row));
}

std::vector<std::string> TextTable::lines() const {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::size_t width = columns_[i].min_width;
    for (const auto& row : rows_) {
      for (const std::string& line : row[i]) width = std::max(width, display_width(line));
    }
    widths.push_back(width);
  }
  std::vector<std::string> result;
  for (const auto& row : rows_) {
    std::size_t height = 1;
    for (const auto& cell : row) height = std::max(height, cell.size());
    for (std::size_t n = 0; n < height; ++n) {
      std::string line;
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        if (i > 0) line += "  ";
        line += padded(n < row[i].size() ? row[i][n] : "", widths[i], columns_[i].align);
      }
      line.erase(line.find_last_not_of(' ') + 1);
      result.push_back(std::move(line));
    }
  }
  return result;
}

}  // namespace stereod::tools
