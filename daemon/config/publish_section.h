// publish of the configuration.
#pragma once

#include "daemon/config/config.h"
#include "daemon/config/yaml_section.h"

namespace stereod {

/// Reads the section `publish`. Throws FileError. Whether a region fits the images is not known here.
void read_publish_section(YamlSection section, PublishConfig& publish);

}  // namespace stereod
