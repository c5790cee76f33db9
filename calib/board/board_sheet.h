// The chessboard as a page to print.
#pragma once

#include <string>
#include <string_view>

#include "calib/board/board.h"

namespace stereod {

/// Width and height in millimeters, upright.
struct Paper {
  std::string_view name;
  double width_mm, height_mm;
};
inline constexpr std::string_view kPapers = "a4, a3, a2, a1, a0, letter, tabloid, fit";

/// The paper of that name, turned and chosen so that the board fits; "fit" makes a page just large enough.
/// Throws UsageError: an unknown name, or a board too large for it (saying which paper does).
Paper paper_for(std::string_view name, const Board& board);

/// The board in true size in the middle of the page, a ruler of 100 mm to check the print with, and what it
/// is. SVG in millimeters, PDF in points of 1/72 inch, one page.
std::string board_svg(const Board& board, const Paper& paper);
std::string board_pdf(const Board& board, const Paper& paper);

}  // namespace stereod
