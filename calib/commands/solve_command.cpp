// SPDX-License-Identifier: BSD-3-Clause
#include "calib/commands/solve_command.h"

#include <cstdio>
#include <memory>

#include "calib/base/errors.h"
#include "calib/commands/commands.h"
#include "calib/report/report.h"
#include "calib/report/summary.h"
#include "daemon/base/file.h"
#include "daemon/config/calibration_file.h"

namespace stereod::calib {

namespace {

struct Flags {
  PairInput input;
  BoardFlags board;
  SolveOutput output;
};

}  // namespace

SolveOptions solve_options(const BoardFlags& flags) {
  SolveOptions options;
  if (flags.board != "auto") options.board = parse_board(flags.board);
  options.square_m = parse_length(flags.square, "--square");
  const auto lens = parse_lens(flags.lens);
  if (!lens) {
    throw UsageError("--lens: found '" + flags.lens + "', allowed are " + std::string(kLensChoices));
  }
  options.lens = *lens;
  return options;
}

int solve_and_write(const std::vector<ImagePair>& images, const SolveOptions& options,
                    const SolveOutput& output) {
  require_writable(output.calibration);
  if (!output.report.empty()) require_writable(output.report);
  const SolveResult result = solve(images, options);
  const Assessment assessment = assess(result);
  std::fputs(summary_text(result, assessment).c_str(), stdout);
  if (!output.report.empty()) {
    write_text_file(output.report, report_page(result, assessment, images));
    std::printf("report: %s\n", output.report.c_str());
  }
  if (assessment.verdict.grade == Grade::kDoAgain) {
    std::printf("calibration: not written because of the verdict; %s is unchanged\n",
                output.calibration.c_str());
    return kExitBadResult;
  }
  write_calibration(output.calibration, result.calibration);
  std::printf("calibration: %s\n", output.calibration.c_str());
  return kExitGood;
}

void add_solve_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("solve", "calibrate from image files of a chessboard");
  auto flags = std::make_shared<Flags>();
  command->add_option(
      "DIRECTORY", flags->input.directory,
      "pairs like left_00.png and right_00.png, or directories left and right with numbered images");
  command->add_option("--left", flags->input.left, "images of the left camera, in order");
  command->add_option("--right", flags->input.right, "images of the right camera, in the same order");
  command->add_option("--side-by-side", flags->input.side_by_side,
                      "images that contain the left and the right image side by side");
  command
      ->add_option("--board", flags->board.board,
                   "inner corners (where four squares meet) across and down, like 9x6; auto detects them")
      ->capture_default_str();
  command
      ->add_option("--square", flags->board.square,
                   "side of a square as measured on the print, with unit: 25mm, 2.5cm, 0.025m, 1in")
      ->required();
  command->add_option("--lens", flags->board.lens, "lens model: " + std::string(kLensChoices))
      ->capture_default_str();
  flags->output.calibration = "calibration.yaml";
  command->add_option("-o,--output", flags->output.calibration, "calibration file for stereod")
      ->capture_default_str();
  command->add_option("--report", flags->output.report, "report about the result, one HTML file");
  command->callback([flags, &status] {
    const SolveOptions options = solve_options(flags->board);
    require_writable(flags->output.calibration);
    require_distinct({flags->output.calibration, flags->output.report}, files_of(flags->input));
    status = solve_and_write(read_pairs(flags->input), options, flags->output);
  });
}

}  // namespace stereod::calib
