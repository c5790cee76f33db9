// cameras.v4l2 of the configuration.
#pragma once

#include "daemon/config/config.h"
#include "daemon/config/yaml_section.h"

namespace stereod {

/// Reads the section v4l2 of `cameras` if it is there, and checks what only cameras need if they are the
/// source. Throws FileError.
void read_v4l2_section(YamlSection& section, CamerasConfig& cameras);

}  // namespace stereod
