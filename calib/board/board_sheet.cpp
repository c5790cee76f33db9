#include "calib/board/board_sheet.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <optional>
#include <vector>

#include "calib/base/errors.h"
#include "calib/report/html.h"

namespace stereod {

namespace {

constexpr double kMargin_mm = 8;   // white round the board, and what printers leave out
constexpr double kFooter_mm = 18;  // for the ruler and the words
constexpr double kRuler_mm = 100;
constexpr std::array<Paper, 7> kKnown = {{{"a4", 210, 297},
                                          {"a3", 297, 420},
                                          {"a2", 420, 594},
                                          {"a1", 594, 841},
                                          {"a0", 841, 1189},
                                          {"letter", 215.9, 279.4},
                                          {"tabloid", 279.4, 431.8}}};

double width_mm(const Board& board) { return 1000 * board.square_m * (board.columns + 1); }
double height_mm(const Board& board) { return 1000 * board.square_m * (board.rows + 1); }

Paper needed(const Board& board) {
  return {"fit", std::max(width_mm(board), kRuler_mm) + 2 * kMargin_mm,
          height_mm(board) + 2 * kMargin_mm + kFooter_mm};
}

// But for capital letters.
bool alike(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char one, unsigned char other) {
    return std::tolower(one) == std::tolower(other);
  });
}

// Upright or on its side.
std::optional<Paper> turned_to_fit(const Paper& paper, const Paper& least) {
  const Paper aside{paper.name, paper.height_mm, paper.width_mm};
  for (const Paper& way : {paper, aside}) {
    if (way.width_mm >= least.width_mm && way.height_mm >= least.height_mm) return way;
  }
  return std::nullopt;
}

// Draws rectangles and text in millimeters from the upper left.
class Canvas {
 public:
  virtual ~Canvas() = default;
  virtual void black(double x, double y, double w, double h) = 0;
  virtual void text(double x, double y, double size_mm, const std::string& words) = 0;
};

std::string size_in_words(const Board& board) { return fixed(1000 * board.square_m, 2) + " mm"; }

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
              "This line is 100 mm long if the page was printed in true size (100 %).");
  canvas.text(ruler_left, ruler_y + 10, 2.8,
              "Squares of " + size_in_words(board) + ", " + std::to_string(board.columns) + " x " +
                  std::to_string(board.rows) + " inner corners. Glue it to something flat and stiff.");
}

class SvgCanvas final : public Canvas {
 public:
  void black(double x, double y, double w, double h) override {
    body_ += "<rect x=\"" + fixed(x, 4) + "\" y=\"" + fixed(y, 4) + "\" width=\"" + fixed(w, 4) +
             "\" height=\"" + fixed(h, 4) + "\"/>\n";
  }
  void text(double x, double y, double size_mm, const std::string& words) override {
    body_ += "<text x=\"" + fixed(x, 4) + "\" y=\"" + fixed(y, 4) + "\" font-size=\"" + fixed(size_mm, 2) +
             "\" font-family=\"sans-serif\">" + escaped(words) + "</text>\n";
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
  void text(double x, double y, double size_mm, const std::string& words) override {
    std::string safe;
    for (const char c : words) {
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
  const Paper least = needed(board);
  if (alike(name, "fit")) return least;
  const auto known =
      std::find_if(kKnown.begin(), kKnown.end(), [&](const Paper& paper) { return alike(paper.name, name); });
  if (known == kKnown.end()) {
    throw UsageError("--paper: found '" + std::string(name) + "', allowed are " + std::string(kPapers));
  }
  if (const auto paper = turned_to_fit(*known, least)) return *paper;
  std::string remedy = "choose smaller squares or --paper fit";
  for (const Paper& paper : kKnown) {
    if (!turned_to_fit(paper, least)) continue;
    remedy = "choose smaller squares or --paper " + std::string(paper.name);
    break;
  }
  throw UsageError("--paper: a board of " + in_words(board) + " with squares of " + size_in_words(board) +
                   " needs " + fixed(least.width_mm, 0) + "×" + fixed(least.height_mm, 0) +
                   " mm with its margins, which " + std::string(name) + " does not have; " + remedy);
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

}  // namespace stereod
