// SPDX-License-Identifier: BSD-3-Clause
#include "calib/board/board_sheet.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <vector>

#include "calib/base/errors.h"
#include "calib/base/text.h"

namespace stereod::calib {

namespace {

constexpr double kMargin_mm = 8;   // white border, which also covers what printers cannot reach
constexpr double kFooter_mm = 18;  // ruler and label
constexpr double kRuler_mm = 100;
constexpr std::array<Paper, 7> kPaperSizes = {{{"a4", 210, 297},
                                               {"a3", 297, 420},
                                               {"a2", 420, 594},
                                               {"a1", 594, 841},
                                               {"a0", 841, 1189},
                                               {"letter", 215.9, 279.4},
                                               {"tabloid", 279.4, 431.8}}};

double width_mm(const Board& board) { return 1000 * board.square_m * (board.columns + 1); }
double height_mm(const Board& board) { return 1000 * board.square_m * (board.rows + 1); }

Paper min_paper(const Board& board) {
  return {"fit", std::max(width_mm(board), kRuler_mm) + 2 * kMargin_mm,
          height_mm(board) + 2 * kMargin_mm + kFooter_mm};
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char l, unsigned char r) { return std::tolower(l) == std::tolower(r); });
}

// Returns the paper upright or landscape, if it is large enough one way.
std::optional<Paper> oriented_to_fit(const Paper& paper, const Paper& minimum) {
  const Paper landscape{paper.name, paper.height_mm, paper.width_mm};
  for (const Paper& way : {paper, landscape}) {
    if (way.width_mm >= minimum.width_mm && way.height_mm >= minimum.height_mm) return way;
  }
  return std::nullopt;
}

// Draws rectangles and text in millimeters from the upper left.
class Canvas {
 public:
  virtual ~Canvas() = default;
  virtual void black(double x, double y, double w, double h) = 0;
  virtual void text(double x, double y, double size_mm, const std::string& content) = 0;
};

std::string square_size(const Board& board) { return fixed(1000 * board.square_m, 2) + " mm"; }

void draw(Canvas& canvas, const Board& board, const Paper& paper) {
  const double square = 1000 * board.square_m;
  const double left = (paper.width_mm - width_mm(board)) / 2;
  const double top = (paper.height_mm - kFooter_mm - height_mm(board)) / 2;
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = 0; column <= board.columns; ++column) {
      if ((row + column) % 2 == 0) canvas.black(left + column * square, top + row * square, square, square);
    }
  }
  const double ruler_left = (paper.width_mm - kRuler_mm) / 2, ruler_y = paper.height_mm - kFooter_mm + 1;
  canvas.black(ruler_left, ruler_y, kRuler_mm, 0.3);
  for (int cm = 0; cm <= 10; ++cm) {
    const double length = cm % 5 == 0 ? 2.5 : 1.5;
    canvas.black(ruler_left + 10 * cm - (cm == 10 ? 0.2 : 0), ruler_y, 0.2, length);
  }
  canvas.text(ruler_left, ruler_y + 6, 2.8,
              "This line is 100 mm long if the page is printed at 100 % scale.");
  canvas.text(ruler_left, ruler_y + 10, 2.8,
              "Squares of " + square_size(board) + ", " + std::to_string(board.columns) + " x " +
                  std::to_string(board.rows) + " inner corners. Glue the page to a flat, stiff plate.");
}

class SvgCanvas final : public Canvas {
 public:
  void black(double x, double y, double w, double h) override {
    body_ += "<rect x=\"" + fixed(x, 4) + "\" y=\"" + fixed(y, 4) + "\" width=\"" + fixed(w, 4) +
             "\" height=\"" + fixed(h, 4) + "\"/>\n";
  }
  void text(double x, double y, double size_mm, const std::string& content) override {
    body_ += "<text x=\"" + fixed(x, 4) + "\" y=\"" + fixed(y, 4) + "\" font-size=\"" + fixed(size_mm, 2) +
             "\" font-family=\"sans-serif\">" + escape_html(content) + "</text>\n";
  }
  std::string file(const Paper& paper) const {
    const std::string w = fixed(paper.width_mm, 2), h = fixed(paper.height_mm, 2);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "mm\" height=\"" + h +
           "mm\" viewBox=\"0 0 " + w + " " + h + "\">\n<rect width=\"" + w + "\" height=\"" + h +
           "\" fill=\"#fff\"/>\n" + body_ + "</svg>\n";
  }

 private:
  std::string body_;
};

class PdfCanvas final : public Canvas {
 public:
  explicit PdfCanvas(const Paper& paper) : paper_(paper) {}
  void black(double x, double y, double w, double h) override {
    body_ +=
        points(x) + " " + points(paper_.height_mm - y - h) + " " + points(w) + " " + points(h) + " re f\n";
  }
  void text(double x, double y, double size_mm, const std::string& content) override {
    std::string safe;
    for (const char c : content) {
      if (c == '(' || c == ')' || c == '\\') safe += '\\';
      safe += c;
    }
    body_ += "BT /F1 " + points(size_mm) + " Tf " + points(x) + " " + points(paper_.height_mm - y) + " Td (" +
             safe + ") Tj ET\n";
  }
  std::string file() const {
    const std::vector<std::string> objects = {
        "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + points(paper_.width_mm) + " " +
            points(paper_.height_mm) + "] /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> >> >>",
        "<< /Length " + std::to_string(body_.size()) + " >>\nstream\n" + body_ + "endstream",
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>"};
    std::string file = "%PDF-1.6\n";
    std::string table = "xref\n0 " + std::to_string(objects.size() + 1) + "\n0000000000 65535 f \n";
    for (std::size_t i = 0; i < objects.size(); ++i) {
      std::string place = std::to_string(file.size());
      place.insert(0, 10 - place.size(), '0');
      table += place + " 00000 n \n";
      file += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
    }
    const std::string start = std::to_string(file.size());
    return file + table + "trailer\n<< /Size " + std::to_string(objects.size() + 1) +
           " /Root 1 0 R >>\nstartxref\n" + start + "\n%%EOF\n";
  }

 private:
  static std::string points(double mm) { return fixed(mm * 72 / 25.4, 4); }

  const Paper& paper_;
  std::string body_;
};

}  // namespace

Paper paper_for(std::string_view name, const Board& board) {
  const Paper minimum = min_paper(board);
  if (equal_ignoring_case(name, "fit")) return minimum;
  const auto known = std::find_if(kPaperSizes.begin(), kPaperSizes.end(),
                                  [&](const Paper& paper) { return equal_ignoring_case(paper.name, name); });
  if (known == kPaperSizes.end()) {
    throw UsageError("--paper: found '" + std::string(name) + "', allowed are " + std::string(kPapers));
  }
  if (const auto paper = oriented_to_fit(*known, minimum)) return *paper;
  std::string remedy = "choose smaller squares or --paper fit";
  for (const Paper& paper : kPaperSizes) {
    if (!oriented_to_fit(paper, minimum)) continue;
    remedy = "choose smaller squares or --paper " + std::string(paper.name);
    break;
  }
  throw UsageError("--paper: a board with " + to_string(board) + " and squares of " + square_size(board) +
                   " needs " + fixed(minimum.width_mm, 0) + "×" + fixed(minimum.height_mm, 0) +
                   " mm with its margins, more than " + std::string(name) + " has; " + remedy);
}

std::string board_svg(const Board& board, const Paper& paper) {
  SvgCanvas canvas;
  draw(canvas, board, paper);
  return canvas.file(paper);
}

std::string board_pdf(const Board& board, const Paper& paper) {
  PdfCanvas canvas(paper);
  draw(canvas, board, paper);
  return canvas.file();
}

}  // namespace stereod::calib
