// SPDX-License-Identifier: BSD-3-Clause
// Opens a camera and agrees with its driver on format and rate.
#pragma once

#include <optional>
#include <string>

#include "daemon/capture/v4l2/camera_fault.h"
#include "daemon/capture/v4l2/pixel_format.h"
#include "daemon/capture/v4l2/video_device.h"

namespace stereod::v4l2 {

/// What a camera is asked for.
struct StreamOptions {
  std::string node;  ///< /dev/video0
  Size size;         ///< of the frames [px]
  double fps = 30;   ///< [Hz]
  std::string format = "auto";
  int fallback_level = 0;  ///< index of format_fallbacks(); the last one if it is larger
};

/// What the driver agreed to. After a failure: what was asked for last.
struct StreamInfo {
  DeviceCapability device;
  DeviceFormat format;
  const PixelFormat* pixel_format = nullptr;
  bool converted = false;   ///< by libv4l2
  double fps = 0;           ///< [Hz] as the driver reports it, else as requested
  int fallback_levels = 0;  ///< number of format fallbacks
};

/// Returns "MJPG 640×480 at 30 Hz", empty if there is no format yet.
std::string describe(const StreamInfo& info);

/// Opens the device, chooses a format, and sets format and rate. Fills @p info as far as it gets. Returns
/// nothing on success.
std::optional<CameraFault> set_up_device(VideoDevice& device, const StreamOptions& options, StreamInfo& info);

}  // namespace stereod::v4l2
