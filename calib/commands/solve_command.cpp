#include "calib/commands/solve_command.h"

#include <cstdio>
#include <memory>

#include "calib/base/errors.h"
#include "calib/commands/commands.h"
#include "calib/report/report.h"
#include "daemon/base/file.h"
#include "daemon/config/calibration_file.h"

namespace stereod {

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

int solve_and_write(const std::vector<ImagePair>& pictures, const SolveOptions& options,
                    const SolveOutput& output) {
  require_writable(output.calibration);
  if (!output.report.empty()) require_writable(output.report);
  const SolveResult result = solve(pictures, options);
  const Assessment assessment = assess(result);
  std::fputs(summary_text(result, assessment).c_str(), stdout);
  if (!output.report.empty()) {
    write_text_file(output.report, report_page(result, assessment, pictures));
    std::printf("report: %s\n", output.report.c_str());
  }
  if (assessment.verdict.grade == Grade::kDoAgain) {
    std::printf("calibration: not written, because it should be done again; %s was not touched\n",
                output.calibration.c_str());
    return kExitBadResult;
  }
  write_calibration(output.calibration, result.calibration);
  std::printf("calibration: %s\n", output.calibration.c_str());
  return kExitGood;
}

void add_solve_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("solve", "calibrate from images of a chessboard");
  auto flags = std::make_shared<Flags>();
  command->add_option(
      "FOLDER", flags->input.directory,
      "pairs like left_00.png and right_00.png, or directories left and right with numbered images");
  command->add_option("--left", flags->input.left, "the left camera's images, in order");
  command->add_option("--right", flags->input.right, "the right camera's images, in the same order");
  command->add_option("--side-by-side", flags->input.side_by_side,
                      "images whose left half is the left camera's, right half the right one's");
  command
      ->add_option("--board", flags->board.board,
                   "inner corners across and down, like 9x6: where four squares meet; auto finds out")
      ->capture_default_str();
  command
      ->add_option("--square", flags->board.square,
                   "side of a square as measured on the print, with its unit: 25mm, 2.5cm, 0.025m, 1in")
      ->required();
  command->add_option("--lens", flags->board.lens, "lens model: " + std::string(kLensChoices))
      ->capture_default_str();
  flags->output.calibration = "calibration.yaml";
  command->add_option("-o,--output", flags->output.calibration, "the calibration, as stereod reads it")
      ->capture_default_str();
  command->add_option("--report", flags->output.report,
                      "a page about the result for a browser, one .html file");
  command->callback([flags, &status] {
    const SolveOptions options = solve_options(flags->board);
    require_writable(flags->output.calibration);
    require_distinct({flags->output.calibration, flags->output.report}, files_of(flags->input));
    status = solve_and_write(read_pairs(flags->input), options, flags->output);
  });
}

}  // namespace stereod
