// SPDX-License-Identifier: BSD-3-Clause
// The controls of a camera by name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/capture/v4l2/video_device.h"
#include "daemon/config/config.h"

namespace stereod::v4l2 {

/// The controls of an open camera. Errors are errno values.
class CameraControls {
 public:
  /// Lists the controls. @p device must be open and outlive this.
  explicit CameraControls(VideoDevice& device) : device_(device), controls_(device.controls()) {}

  /// Sets each control and reads it back. Switches off automatic modes that would overrule a value, unless @p
  /// values names the mode itself. Returns a "; "-separated list of controls that could not be set; empty on
  /// success.
  std::string apply(const ControlValues& values);

  /// Sets a control and the automatic mode that drives it to their default values.
  void reset(std::uint32_t id);

  /// Returns the control with this V4L2_CID_* number, null if the camera does not have it.
  const DeviceControl* find(std::uint32_t id) const;
  /// Returns the control with this name in the present or an earlier kernel, null if the camera does not have
  /// it.
  const DeviceControl* find(const std::string& name) const;

  /// Switches off the automatic mode that drives this control, if there is one.
  int disable_auto_mode(std::uint32_t id);

  const std::vector<DeviceControl>& all() const { return controls_; }

 private:
  std::string apply_one(const std::string& name, std::int32_t value);

  VideoDevice& device_;
  std::vector<DeviceControl> controls_;
};

}  // namespace stereod::v4l2
