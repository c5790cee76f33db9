// A camera's controls by name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/capture/v4l2/video_device.h"
#include "daemon/config/config.h"

namespace stereod {

/// The controls of an opened camera.
class CameraControls {
 public:
  explicit CameraControls(VideoDevice& device) : device_(device), controls_(device.controls()) {}

  /// Sets each control and reads it back. Automatic modes that would fight a value are switched off before it
  /// is set, unless the values name the mode itself. What did not take is told in sentences, "; " between
  /// them; empty if everything is as it should be.
  std::string apply(const ControlValues& values);

  /// Gives a control and the automatic mode that sets it the values the camera has from its maker.
  void reset(std::uint32_t id);

  /// The control with this V4L2 number; null if the camera has none.
  const DeviceControl* find(std::uint32_t id) const;
  /// The control with this name, as the kernel has it or had it in other versions; null if there is none.
  const DeviceControl* find(const std::string& name) const;

  /// Switches off the automatic mode that sets this control by itself, if there is one. Errno values.
  int switch_off_automatic(std::uint32_t id);

  const std::vector<DeviceControl>& all() const { return controls_; }

 private:
  std::string apply_one(const std::string& name, std::int32_t value);

  VideoDevice& device_;
  std::vector<DeviceControl> controls_;
};

}  // namespace stereod
