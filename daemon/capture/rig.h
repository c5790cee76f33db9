// The two cameras that the configuration names.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/calibration.h"
#include "daemon/capture/frame_source.h"
#include "daemon/config/config.h"

namespace stereod {

/// Two frame sources of the same size and what is known of their geometry.
struct Rig {
  std::unique_ptr<FrameSource> left, right;
  std::string left_name, right_name;       ///< for the status message
  std::optional<Calibration> calibration;  ///< for images of the sources' size
};

/// Opens what the configuration asks for. Throws FileError (a picture or the calibration cannot be used, or
/// is for another image size).
Rig open_rig(const Config& config);

}  // namespace stereod
