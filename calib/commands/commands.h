// The commands of stereo-calibrate. Each declares its options in `app` and does its work as a callback of it;
// what it returns for the process is left in `status`. They throw UsageError, FileError and CalibrationError.
#pragma once

#include <CLI/CLI.hpp>

namespace stereod {

void add_solve_command(CLI::App& app, int& status);
void add_board_command(CLI::App& app, int& status);
void add_exchange_commands(CLI::App& app, int& status);  ///< import and export
void add_capture_command(CLI::App& app, int& status);
void add_check_command(CLI::App& app, int& status);

}  // namespace stereod
