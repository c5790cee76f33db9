// From the name of a camera in the configuration to its video node.
#pragma once

#include <optional>
#include <string>

#include "core/sync/pairing.h"
#include "daemon/capture/v4l2/camera_fault.h"
#include "daemon/capture/v4l2/video_system.h"

namespace stereod {

/// Finds the node that `name` stands for now. A name is
///   a path: /dev/v4l/by-path/… (a port: left stays left whatever is plugged in), by-id, or /dev/videoN;
///   a file name below by-path or by-id alone;
///   serial:S, the camera with this USB serial number;
///   auto: the first (left) or second (right) camera in the order of their ports.
/// Writes the node, and for auto the stable name that stands for the same camera from now on.
std::optional<CameraFault> find_camera(VideoSystem& system, Side side, const std::string& name,
                                       std::string& node, std::string& stable_name);

}  // namespace stereod
