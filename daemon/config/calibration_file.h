// calibration.yaml: what stereo-calibrate writes and the daemon reads.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/calibration.h"
#include "daemon/base/file_error.h"

namespace stereod {

/// Reads a calibration. Strict: every key must be there and known, every number finite and in range, the
/// whole free of what problem_with() finds. The id is computed from the numbers, whatever the file says, so
/// that an edited file has another. Throws FileError: "file:line: key: what was found, what is allowed".
Calibration read_calibration(const std::filesystem::path& file);

/// The file's text: commented, and every number with as many digits as reading it back to the bit takes.
std::string calibration_text(const Calibration& calibration);

/// Writes a sound calibration as write_text_file() does: what was there before is replaced as a whole or not
/// at all. Throws FileError.
void write_calibration(const std::filesystem::path& file, const Calibration& calibration);

}  // namespace stereod
