// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes calibration.yaml.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/calibration.h"
#include "daemon/base/file_error.h"

namespace stereod {

/// Reads a calibration strictly: every key is required and known, every number finite and in range, and problem_with()
/// finds nothing. The id is computed from the numbers, so that an edited file has another one.
/// @throws FileError "file:line: key: what was found, what is allowed".
Calibration read_calibration(const std::filesystem::path& file);

/// Returns the text of the file, with comments. Numbers have the digits that read back to the same bits.
std::string calibration_text(const Calibration& calibration);

/// Writes a calibration without problem_with() by write_text_file(): as a whole or not at all.
/// @throws FileError.
void write_calibration(const std::filesystem::path& file, const Calibration& calibration);

}  // namespace stereod
