// Calibrating, with the files that come of it.
#pragma once

#include <filesystem>
#include <string>

#include "calib/solve/solve.h"

namespace stereod {

struct SolveOutput {
  std::filesystem::path calibration;
  std::filesystem::path report;  ///< empty: none
};

/// The options that say which board, square and lens, as they stand on the command line.
struct BoardFlags {
  std::string board = "auto";
  std::string square;
  std::string lens = "pinhole";
};

/// Throws UsageError.
SolveOptions solve_options(const BoardFlags& flags);

/// Solves, prints the summary, writes the report and, unless the verdict is to do it again, the calibration.
/// Returns the status to end with.
int solve_and_write(const std::vector<ImagePair>& pictures, const SolveOptions& options,
                    const SolveOutput& output);

}  // namespace stereod
