// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/tap/text_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace stereod::tools {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Bytes of the UTF-8 character at the front of `text` (not empty) if it may be printed, else 0.
std::size_t printable_character(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  if (first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0) return 0;  // control characters again
  for (std::size_t i = 1; i < length; ++i) {
    if (!is_continuation(text[i])) return 0;
  }
  return length;
}

/// Bytes of the first `width` characters.
std::size_t bytes_of(std::string_view text, std::size_t width) {
  std::size_t bytes = 0;
  while (bytes < text.size()) {
    if (!is_continuation(text[bytes]) && width-- == 0) break;
    ++bytes;
  }
  return bytes;
}

std::string padded(const std::string& text, std::size_t width, TextTable::Align align) {
  const std::string space(width - std::min(width, display_width(text)), ' ');
  return align == TextTable::Align::kLeft ? text + space : space + text;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = printable_character(text);
    if (length == 0) {
      result += '?';
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

std::size_t display_width(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char buffer[350];  // the largest double has 309 digits
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
  return buffer;
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines;
  while (display_width(text) > width) {
    const std::size_t limit = bytes_of(text, width);
    const std::size_t space = text.substr(0, limit + 1).rfind(' ');
    const bool at_space = space != std::string_view::npos && space > 0;
    lines.emplace_back(text.substr(0, at_space ? space : limit));
    text.remove_prefix(at_space ? space + 1 : limit);
  }
  lines.emplace_back(text);
  return lines;
}

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
