// SPDX-License-Identifier: BSD-3-Clause
// The commands of stereo-calibrate.
#pragma once

#include <CLI/CLI.hpp>

namespace stereod::calib {

/// Each function adds one command to @p app. The command runs as a callback of @p app, writes the exit status to
/// @p status, and throws UsageError, FileError, CalibrationError or BusError.
void add_solve_command(CLI::App& app, int& status);
void add_board_command(CLI::App& app, int& status);
void add_interop_commands(CLI::App& app, int& status);  ///< import and export
void add_capture_command(CLI::App& app, int& status);
void add_check_command(CLI::App& app, int& status);

}  // namespace stereod::calib
