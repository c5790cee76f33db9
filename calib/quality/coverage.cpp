// SPDX-License-Identifier: BSD-3-Clause
#include "calib/quality/coverage.h"

#include <algorithm>
#include <cmath>

namespace stereod::calib {

void Coverage::add(const Corners& corners) {
  for (const Point2& p : corners) {
    const int column = static_cast<int>(std::floor((p.x + 0.5) * kColumns / image_.width));
    const int row = static_cast<int>(std::floor((p.y + 0.5) * kRows / image_.height));
    if (column < 0 || column >= kColumns || row < 0 || row >= kRows) continue;
    ++cells_[index(column, row)];
  }
}

double Coverage::share() const {
  const auto covered = std::count_if(cells_.begin(), cells_.end(), [](int count) { return count > 0; });
  return static_cast<double>(covered) / static_cast<double>(cells_.size());
}

std::vector<std::string> Coverage::empty_parts() const {
  struct Part {
    int number;
    double share;
  };
  std::vector<Part> parts;
  for (int number = 0; number < 9; ++number) {
    // Columns are split 2 + 4 + 2, rows 2 + 2 + 2.
    const int first_columns[] = {0, 2, 6, 8}, first_rows[] = {0, 2, 4, 6};
    int cells = 0, covered = 0;
    for (int row = first_rows[number / 3]; row < first_rows[number / 3 + 1]; ++row) {
      for (int column = first_columns[number % 3]; column < first_columns[number % 3 + 1]; ++column) {
        ++cells;
        covered += count(column, row) > 0 ? 1 : 0;
      }
    }
    if (2 * covered < cells) parts.push_back({number, static_cast<double>(covered) / cells});
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.share < b.share; });
  std::vector<std::string> names;
  names.reserve(parts.size());
  for (const Part& part : parts) names.push_back(image_part_name(part.number));
  return names;
}

std::string image_part_name(int part) {
  static const char* const kNames[] = {"the upper left", "the top",    "the upper right",
                                       "the left side",  "the middle", "the right side",
                                       "the lower left", "the bottom", "the lower right"};
  return kNames[part];
}

}  // namespace stereod::calib
