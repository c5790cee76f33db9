// The two cameras that the configuration names.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/geometry/calibration.h"
#include "daemon/capture/frame_source.h"
#include "daemon/capture/v4l2/v4l2_camera.h"
#include "daemon/capture/v4l2/video_system.h"
#include "daemon/config/config.h"

namespace stereod {

/// Two frame sources of the same size and what is known of their geometry.
struct StereoSource {
  std::unique_ptr<VideoSystem> video;      ///< what the cameras are read with, if they are real
  std::shared_ptr<V4l2PairState> cameras;  ///< what they know of each other, if they are real
  std::unique_ptr<FrameSource> left, right;
  std::string left_name, right_name;             ///< for the status message
  std::optional<Calibration> scene_calibration;  ///< of a rendered scene's own cameras
  std::optional<Calibration> calibration;        ///< calibration_for() them
};

/// Opens what the configuration asks for. Throws FileError (a image or the calibration cannot be used, or
/// is for another image size). Cameras are not opened yet: that is done in the thread that reads them, and
/// none need be there.
StereoSource open_stereo_source(const Config& config);

/// The calibration for these cameras: the configured file's, else the rendered scene's own, else none. Throws
/// FileError as above.
std::optional<Calibration> calibration_for(const Config& config, const StereoSource& rig);

/// What open_stereo_source() makes of cameras of this system, for tests. `log` takes what they have to say.
StereoSource make_v4l2_stereo_source(const CamerasConfig& cameras, std::unique_ptr<VideoSystem> system,
                                     const CameraLog& log);

}  // namespace stereod
