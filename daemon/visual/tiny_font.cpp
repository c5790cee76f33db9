// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/visual/tiny_font.h"

#include <algorithm>
#include <array>

namespace stereod {

namespace {

struct Letter {
  char character;
  int width;
  std::array<const char*, kLetterHeight + kLetterDescent> rows;
};

// The last letter stands for unknown characters.
constexpr std::array kLetters{
    Letter{'0', 5, {" ### ", "#   #", "#  ##", "# # #", "##  #", "#   #", " ### ", "     ", "     "}},
    Letter{'1', 5, {"  #  ", " ##  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### ", "     ", "     "}},
    Letter{'2', 5, {" ### ", "#   #", "    #", "   # ", "  #  ", " #   ", "#####", "     ", "     "}},
    Letter{'3', 5, {" ### ", "#   #", "    #", "  ## ", "    #", "#   #", " ### ", "     ", "     "}},
    Letter{'4', 5, {"   # ", "  ## ", " # # ", "#  # ", "#####", "   # ", "   # ", "     ", "     "}},
    Letter{'5', 5, {"#####", "#    ", "#### ", "    #", "    #", "#   #", " ### ", "     ", "     "}},
    Letter{'6', 5, {"  ## ", " #   ", "#    ", "#### ", "#   #", "#   #", " ### ", "     ", "     "}},
    Letter{'7', 5, {"#####", "    #", "   # ", "  #  ", "  #  ", "  #  ", "  #  ", "     ", "     "}},
    Letter{'8', 5, {" ### ", "#   #", "#   #", " ### ", "#   #", "#   #", " ### ", "     ", "     "}},
    Letter{'9', 5, {" ### ", "#   #", "#   #", " ####", "    #", "   # ", " ##  ", "     ", "     "}},
    Letter{'.', 2, {"  ", "  ", "  ", "  ", "  ", "##", "##", "  ", "  "}},
    Letter{'-', 4, {"    ", "    ", "    ", "####", "    ", "    ", "    ", "    ", "    "}},
    Letter{'m', 5, {"     ", "     ", "## # ", "# # #", "# # #", "# # #", "# # #", "     ", "     "}},
    Letter{'p', 5, {"     ", "     ", "#### ", "#   #", "#   #", "#   #", "#### ", "#    ", "#    "}},
    Letter{'x', 5, {"     ", "     ", "#   #", " # # ", "  #  ", " # # ", "#   #", "     ", "     "}},
    Letter{' ', 3, {"   ", "   ", "   ", "   ", "   ", "   ", "   ", "   ", "   "}},
    Letter{'?', 5, {"#####", "#   #", "#   #", "#   #", "#   #", "#   #", "#####", "     ", "     "}},
};

const Letter& letter_for(char character) {
  const auto* found = std::find_if(kLetters.begin(), kLetters.end() - 1,
                                   [&](const Letter& l) { return l.character == character; });
  return *found;
}

void fill_square(ImageView<Rgb> image, int x, int y, int side, Rgb color) {
  for (int row = std::max(y, 0); row < std::min(y + side, image.height()); ++row) {
    for (int column = std::max(x, 0); column < std::min(x + side, image.width()); ++column) {
      image.at(column, row) = color;
    }
  }
}

}  // namespace

int text_width(std::string_view text, int zoom) {
  int dots = 0;
  for (const char character : text) dots += letter_for(character).width + 1;
  return std::max(0, dots - 1) * zoom;
}

void draw_text(ImageView<Rgb> image, int x, int y, std::string_view text, Rgb color, int zoom) {
  for (const char character : text) {
    const Letter& letter = letter_for(character);
    for (int row = 0; row < kLetterHeight + kLetterDescent; ++row) {
      for (int column = 0; column < letter.width; ++column) {
        if (letter.rows[static_cast<std::size_t>(row)][column] == '#') {
          fill_square(image, x + column * zoom, y + row * zoom, zoom, color);
        }
      }
    }
    x += (letter.width + 1) * zoom;
  }
}

}  // namespace stereod
