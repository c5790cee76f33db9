// SPDX-License-Identifier: BSD-3-Clause
// Solves for a calibration and writes its files.
#pragma once

#include <filesystem>
#include <string>

#include "calib/solve/solve.h"

namespace stereod::calib {

struct SolveOutput {
  std::filesystem::path calibration;
  std::filesystem::path report;  ///< empty: no report
};

/// Board, square and lens as given on the command line.
struct BoardFlags {
  std::string board = "auto";
  std::string square;
  std::string lens = "pinhole";
};

/// @throws UsageError if a value is invalid.
SolveOptions solve_options(const BoardFlags& flags);

/// Solves, prints the summary, and writes the report and, unless the verdict is "do again", the calibration.
/// Returns the exit status.
int solve_and_write(const std::vector<ImagePair>& images, const SolveOptions& options,
                    const SolveOutput& output);

}  // namespace stereod::calib
