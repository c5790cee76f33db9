// The two cameras that the configuration names.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/calibration.h"
#include "daemon/capture/frame_source.h"
#include "daemon/capture/v4l2/v4l2_camera.h"
#include "daemon/capture/v4l2/video_system.h"
#include "daemon/config/config.h"

namespace stereod {

/// Two frame sources of the same size and what is known of their geometry.
struct Rig {
  std::unique_ptr<VideoSystem> video;   ///< what the cameras are read with, if they are real
  std::shared_ptr<CameraPair> cameras;  ///< what they know of each other, if they are real
  std::unique_ptr<FrameSource> left, right;
  std::string left_name, right_name;       ///< for the status message
  std::optional<Calibration> calibration;  ///< for images of the sources' size
};

/// Opens what the configuration asks for. Throws FileError (a picture or the calibration cannot be used, or
/// is for another image size). Cameras are not opened yet: that is done in the thread that reads them, and
/// none need be there.
Rig open_rig(const Config& config);

/// The same for cameras of this system, for tests. `log` takes what they have to say.
Rig make_v4l2_rig(const CamerasConfig& cameras, std::unique_ptr<VideoSystem> system, const CameraLog& log);

}  // namespace stereod
