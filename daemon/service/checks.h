// Whether a configuration can work, found out before anything is started with it.
#pragma once

#include <filesystem>
#include <optional>

#include "daemon/capture/stereo_source.h"
#include "daemon/config/config.h"

namespace stereod {

/// What needs no cameras: that the LCM URL is one, that the CPU has what matcher.isa asks for. `file` is
/// where the configuration stands, for the complaint. Throws FileError.
void check_config(const Config& config, const std::filesystem::path& file);

/// That frames of this size can be matched and published. Throws FileError.
void check_frame_size(const Config& config, const std::filesystem::path& file, Size size);

/// That nothing is asked for that needs a calibration and has none. Throws FileError.
void check_calibration(const Config& config, const std::filesystem::path& file,
                       const std::optional<Calibration>& calibration);

/// Finds everything that can never work before anything touches the network, which may only be late: these
/// checks and open_stereo_source(). Throws FileError.
StereoSource open_checked_rig(const Config& config, const std::filesystem::path& file);

}  // namespace stereod
