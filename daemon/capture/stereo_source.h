// SPDX-License-Identifier: BSD-3-Clause
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

/// Two frame sources with the same frame size, and what is known of their geometry. Owns everything the
/// sources use.
struct StereoSource {
  std::unique_ptr<v4l2::VideoSystem> video;      ///< access to the kernel; null unless the cameras are real
  std::shared_ptr<v4l2::V4l2PairState> cameras;  ///< state that both cameras share; null unless they are real
  std::unique_ptr<FrameSource> left, right;
  std::string left_name, right_name;             ///< for the status message
  std::optional<Calibration> scene_calibration;  ///< of a rendered scene: exact
  std::optional<Calibration> calibration;        ///< see calibration_for()
};

/// Creates the sources of @p config. Reads recordings and renders scenes; does not open cameras, which the
/// capture threads do, and which may be plugged in at any later time.
/// @throws FileError if an image, a log or the calibration cannot be read, or the calibration is for another
/// image size.
StereoSource open_stereo_source(const Config& config);

/// Returns the configured calibration file's content, else the rendered scene's own calibration, else
/// nothing. Applies rectify.alpha.
/// @throws FileError as above.
std::optional<Calibration> calibration_for(const Config& config, const StereoSource& source);

/// Creates the sources for two real cameras on @p system. @p log receives a sentence when a camera's state
/// changes.
StereoSource make_v4l2_stereo_source(const CamerasConfig& cameras, std::unique_ptr<v4l2::VideoSystem> system,
                                     const v4l2::CameraLog& log);

}  // namespace stereod
