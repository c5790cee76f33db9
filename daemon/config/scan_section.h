// scan of the configuration.
#pragma once

#include "daemon/config/config.h"
#include "daemon/config/yaml_section.h"

namespace stereod {

/// Reads the section `scan`. Throws FileError.
void read_scan_section(YamlSection section, ScanConfig& scan);

}  // namespace stereod
