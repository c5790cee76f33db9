// SPDX-License-Identifier: BSD-3-Clause
// Records which parts of the image have seen the board.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "calib/board/board.h"
#include "core/base/image.h"

namespace stereod::calib {

/// Counts corners in a grid of 8×6 cells over the image.
class Coverage {
 public:
  static constexpr int kColumns = 8, kRows = 6;

  explicit Coverage(Size image) : image_(image) {}
  /// Counts @p corners; ignores those outside the image.
  void add(const Corners& corners);

  int count(int column, int row) const { return cells_[index(column, row)]; }
  /// Returns the share of cells with at least one corner, 0…1.
  double share() const;
  /// Returns the names (image_part_name()) of those of the nine image parts that have less than half of their cells
  /// covered, emptiest first.
  std::vector<std::string> empty_parts() const;

 private:
  static std::size_t index(int column, int row) { return static_cast<std::size_t>(row * kColumns + column); }

  Size image_;
  std::array<int, static_cast<std::size_t>(kColumns* kRows)> cells_{};
};

/// Returns the name of part 0…8 of an image divided into 3×3 parts, row by row: "the upper left", "the middle", …
std::string image_part_name(int part);

}  // namespace stereod::calib
