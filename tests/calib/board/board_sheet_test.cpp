// SPDX-License-Identifier: BSD-3-Clause
#include "calib/board/board_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "calib/base/errors.h"

namespace stereod::calib {
namespace {

using testing::HasSubstr;

const Board kBoard{9, 6, 0.025};

std::string refusal(const std::string& paper, const Board& board) {
  try {
    paper_for(paper, board);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "none";
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

TEST(BoardSheet, Paper_OrientedToFit) {
  EXPECT_EQ(paper_for("a4", kBoard).width_mm, 297);
  EXPECT_EQ(paper_for("A4", kBoard).width_mm, 297);
  EXPECT_EQ(paper_for("a4", (Board{5, 8, 0.025})).width_mm, 210);
  EXPECT_GE(paper_for("fit", (Board{30, 20, 0.05})).width_mm, 31 * 50);
  EXPECT_THAT(refusal("a4", (Board{9, 6, 0.04})), HasSubstr("choose smaller squares or --paper a2"));
  EXPECT_THAT(refusal("a4", (Board{50, 50, 0.04})), HasSubstr("--paper fit"));
  EXPECT_THAT(refusal("a7", kBoard), HasSubstr("found 'a7', allowed are a4"));
}

TEST(BoardSheet, Svg_TrueSize) {
  const std::string svg = board_svg(kBoard, paper_for("a4", kBoard));
  EXPECT_THAT(svg, HasSubstr("width=\"297.00mm\" height=\"210.00mm\" viewBox=\"0 0 297.00 210.00\""));
  EXPECT_EQ(count(svg, "width=\"25.0000\" height=\"25.0000\""), 35U);  // half of 10×7 squares
  EXPECT_THAT(svg, HasSubstr("width=\"100.0000\" height=\"0.3000\""));
  EXPECT_THAT(svg, HasSubstr("Squares of 25.00 mm, 9 x 6 inner corners"));
}

TEST(BoardSheet, Pdf_PointsAndXref) {
  const std::string pdf = board_pdf(kBoard, paper_for("a4", kBoard));
  EXPECT_THAT(pdf, HasSubstr("/MediaBox [0 0 841.8898 595.2756]"));
  EXPECT_EQ(count(pdf, " 70.8661 70.8661 re f"), 35U);  // 25 mm in 1/72 inch
  EXPECT_THAT(pdf, HasSubstr("/PrintScaling /None"));
  // Each object is where the table says.
  std::size_t entry = pdf.find("0000000000 65535 f \n") + 20;
  for (int object = 1; object <= 5; ++object, entry += 20) {
    const std::size_t place = std::stoul(pdf.substr(entry, 10));
    EXPECT_EQ(pdf.substr(place, 7), std::to_string(object) + " 0 obj");
  }
  const std::size_t start = std::stoul(pdf.substr(pdf.find("startxref\n") + 10));
  EXPECT_EQ(pdf.substr(start, 4), "xref");
  const std::size_t stream = pdf.find("stream\n") + 7;
  EXPECT_EQ(std::stoul(pdf.substr(pdf.find("/Length ") + 8)), pdf.find("endstream") - stream);
}

}  // namespace
}  // namespace stereod::calib
