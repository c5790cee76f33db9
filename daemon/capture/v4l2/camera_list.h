// What cameras there are, for people.
#pragma once

#include <string>

#include "daemon/capture/v4l2/video_system.h"

namespace stereod {

/// Every camera with its stable names, bus, formats, sizes, rates and controls, to copy the configuration
/// from; a sentence if there is none, or if one cannot be opened.
std::string list_cameras(VideoSystem& system);

}  // namespace stereod
