// SPDX-License-Identifier: BSD-3-Clause
// Draws the chessboard as a page to print.
#pragma once

#include <string>
#include <string_view>

#include "calib/board/board.h"

namespace stereod::calib {

/// A sheet of paper.
struct Paper {
  std::string_view name;
  double width_mm, height_mm;
};
inline constexpr std::string_view kPapers = "a4, a3, a2, a1, a0, letter, tabloid, fit";

/// Returns the paper @p name (case-insensitive), upright or landscape so that @p board fits. "fit" is a page
/// just large enough.
/// @throws UsageError if the name is unknown or the board does not fit; names the smallest paper that does.
Paper paper_for(std::string_view name, const Board& board);

/// Return one page with the board in true size, a ruler of 100 mm to check the print with, and a label. SVG
/// uses millimeters, PDF points of 1/72 inch.
std::string board_svg(const Board& board, const Paper& paper);
std::string board_pdf(const Board& board, const Paper& paper);

}  // namespace stereod::calib
