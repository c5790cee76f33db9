// SPDX-License-Identifier: BSD-3-Clause
// Checks that a configuration can work, before anything is started.
#pragma once

#include <filesystem>
#include <optional>

#include "daemon/capture/stereo_source.h"
#include "daemon/config/config.h"

namespace stereod {

// @p file is the file that the configuration was read from. The functions throw FileError: "file:line: key:
// what was found, what is allowed".

/// Checks what needs no cameras: the LCM URL, and that this CPU has the instruction set of matcher.isa.
void check_config(const Config& config, const std::filesystem::path& file);

/// Checks that frames of this size [px] can be matched and published.
void check_frame_size(const Config& config, const std::filesystem::path& file, Size size);

/// Checks that the calibration leaves an image, and that without one no output is enabled that needs it.
void check_calibration(const Config& config, const std::filesystem::path& file,
                       const std::optional<Calibration>& calibration);

/// Opens the sources and runs all checks, so that everything that can never work is found before the network
/// is used, which may only be late.
StereoSource open_checked_source(const Config& config, const std::filesystem::path& file);

}  // namespace stereod
