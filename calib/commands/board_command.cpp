// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <filesystem>
#include <memory>

#include "calib/base/errors.h"
#include "calib/board/board_sheet.h"
#include "calib/commands/commands.h"
#include "daemon/base/file.h"

namespace stereod::calib {

namespace {

struct Flags {
  std::string board = "9x6", square = "25mm", paper = "a4";
  std::filesystem::path output = "board.pdf";
};

void run(const Flags& flags) {
  Board board = parse_board(flags.board);
  board.square_m = parse_length(flags.square, "--square");
  const Paper paper = paper_for(flags.paper, board);
  const bool svg = flags.output.extension() == ".svg";
  if (!svg && flags.output.extension() != ".pdf") {
    throw UsageError(flags.output.string() + ": unknown extension; use .pdf or .svg");
  }
  write_text_file(flags.output, svg ? board_svg(board, paper) : board_pdf(board, paper));
  std::printf("%s: %s, squares of %g mm; print at 100 %% scale and measure a square\n", flags.output.c_str(),
              to_string(board).c_str(), 1000 * board.square_m);
  if (board.ambiguous()) {
    std::printf(
        "warning: this board looks the same after half a turn, so both cameras must be the same way up; a board "
        "with one even and one odd count, like 9x6, has no such restriction\n");
  }
}

}  // namespace

void add_board_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("board", "write a chessboard to print in true size");
  auto flags = std::make_shared<Flags>();
  command->add_option("--board", flags->board, "inner corners (where four squares meet) across and down")
      ->capture_default_str();
  command->add_option("--square", flags->square, "side of a square, with unit")->capture_default_str();
  command->add_option("--paper", flags->paper, std::string(kPapers))->capture_default_str();
  command->add_option("-o,--output", flags->output, "output file, .pdf or .svg")->capture_default_str();
  command->callback([flags] { run(*flags); });
}

}  // namespace stereod::calib
