// Where in the image the board has been.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "calib/board/board.h"
#include "core/base/image.h"

namespace stereod {

/// The image as a grid of 8×6 cells, and how many corners lay in each.
class Coverage {
 public:
  static constexpr int kColumns = 8, kRows = 6;

  explicit Coverage(Size image) : image_(image) {}
  void add(const Corners& corners);

  int count(int column, int row) const { return cells_[index(column, row)]; }
  /// The share of cells with at least one corner, 0 … 1.
  double share() const;
  /// The parts of the image, of nine, with the least of their cells covered, in words ("the upper left"),
  /// worst first; those at least half covered are not among them.
  std::vector<std::string> empty_parts() const;

 private:
  static std::size_t index(int column, int row) { return static_cast<std::size_t>(row * kColumns + column); }

  Size image_;
  std::array<int, static_cast<std::size_t>(kColumns* kRows)> cells_{};
};

/// "the upper left", "the middle", …: part 0 … 8 of an image cut into three by three, row by row.
std::string part_in_words(int part);

}  // namespace stereod
