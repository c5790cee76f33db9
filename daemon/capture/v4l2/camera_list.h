// SPDX-License-Identifier: BSD-3-Clause
// The list of cameras for people.
#pragma once

#include <string>

#include "daemon/capture/v4l2/video_system.h"

namespace stereod::v4l2 {

/// Returns a text that lists every camera with its stable names, bus, formats, sizes, rates and controls,
/// from which the configuration can be copied. Contains a sentence for a camera that cannot be opened, and if
/// there is no camera.
std::string list_cameras(VideoSystem& system);

}  // namespace stereod::v4l2
