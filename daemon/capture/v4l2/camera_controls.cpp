// SPDX-License-Identifier: BSD-3-Clause
// Setting controls by name.
#include "daemon/capture/v4l2/camera_controls.h"

#include <linux/v4l2-controls.h>

#include <algorithm>
#include <cstring>

namespace stereod::v4l2 {
namespace {

/// A control, the automatic mode that drives it, and the mode's value for "off".
struct AutoMode {
  std::uint32_t value, mode;
  std::int32_t off;
};
constexpr AutoMode kAutoModes[] = {
    {V4L2_CID_EXPOSURE_ABSOLUTE, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL},
    {V4L2_CID_EXPOSURE, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL},
    {V4L2_CID_GAIN, V4L2_CID_AUTOGAIN, 0},
    {V4L2_CID_WHITE_BALANCE_TEMPERATURE, V4L2_CID_AUTO_WHITE_BALANCE, 0},
    {V4L2_CID_RED_BALANCE, V4L2_CID_AUTO_WHITE_BALANCE, 0},
    {V4L2_CID_BLUE_BALANCE, V4L2_CID_AUTO_WHITE_BALANCE, 0},
    {V4L2_CID_FOCUS_ABSOLUTE, V4L2_CID_FOCUS_AUTO, 0},
    {V4L2_CID_HUE, V4L2_CID_HUE_AUTO, 0},
    {V4L2_CID_BRIGHTNESS, V4L2_CID_AUTOBRIGHTNESS, 0},
};

/// Linux 5.18 renamed some controls; both names are accepted.
struct NamedControl {
  const char* name;
  std::uint32_t id;
};
constexpr NamedControl kNames[] = {
    {"auto_exposure", V4L2_CID_EXPOSURE_AUTO},
    {"exposure_auto", V4L2_CID_EXPOSURE_AUTO},
    {"exposure_time_absolute", V4L2_CID_EXPOSURE_ABSOLUTE},
    {"exposure_absolute", V4L2_CID_EXPOSURE_ABSOLUTE},
    {"exposure_dynamic_framerate", V4L2_CID_EXPOSURE_AUTO_PRIORITY},
    {"exposure_auto_priority", V4L2_CID_EXPOSURE_AUTO_PRIORITY},
    {"white_balance_automatic", V4L2_CID_AUTO_WHITE_BALANCE},
    {"white_balance_temperature_auto", V4L2_CID_AUTO_WHITE_BALANCE},
    {"focus_automatic_continuous", V4L2_CID_FOCUS_AUTO},
    {"focus_auto", V4L2_CID_FOCUS_AUTO},
};

bool is_mode(std::uint32_t id) {
  return std::any_of(std::begin(kAutoModes), std::end(kAutoModes),
                     [&](const AutoMode& automatic) { return automatic.mode == id; });
}

void append(std::string& text, const std::string& sentence) {
  if (sentence.empty()) return;
  if (!text.empty()) text += "; ";
  text += sentence;
}

}  // namespace

const DeviceControl* CameraControls::find(std::uint32_t id) const {
  const auto found = std::find_if(controls_.begin(), controls_.end(),
                                  [&](const DeviceControl& control) { return control.id == id; });
  return found == controls_.end() ? nullptr : &*found;
}

const DeviceControl* CameraControls::find(const std::string& name) const {
  for (const DeviceControl& control : controls_) {
    if (control.name == name) return &control;
  }
  for (const NamedControl& known : kNames) {
    if (known.name == name) return find(known.id);
  }
  return nullptr;
}

int CameraControls::disable_auto_mode(std::uint32_t id) {
  for (const AutoMode& automatic : kAutoModes) {
    if (automatic.value != id || find(automatic.mode) == nullptr) continue;
    if (const int error = device_.set_control(automatic.mode, automatic.off)) return error;
  }
  return 0;
}

void CameraControls::reset(std::uint32_t id) {
  const DeviceControl* control = find(id);
  if (control == nullptr) return;
  // The value first: an active automatic mode would overrule it.
  device_.set_control(id, control->default_value);
  for (const AutoMode& automatic : kAutoModes) {
    const DeviceControl* mode = automatic.value == id ? find(automatic.mode) : nullptr;
    if (mode != nullptr) device_.set_control(mode->id, mode->default_value);
  }
}

std::string CameraControls::apply(const ControlValues& values) {
  std::string problems;
  std::vector<std::uint32_t> named_modes;
  // Modes first: a value that an active mode overrules is lost.
  for (const auto& [name, value] : values) {
    const DeviceControl* control = find(name);
    if (control == nullptr || !is_mode(control->id)) continue;
    named_modes.push_back(control->id);
    append(problems, apply_one(name, value));
  }
  for (const auto& [name, value] : values) {
    const DeviceControl* control = find(name);
    if (control != nullptr && is_mode(control->id)) continue;
    if (control != nullptr) {
      const bool named =
          std::any_of(std::begin(kAutoModes), std::end(kAutoModes), [&](const AutoMode& automatic) {
            return automatic.value == control->id &&
                   std::find(named_modes.begin(), named_modes.end(), automatic.mode) != named_modes.end();
          });
      if (!named) disable_auto_mode(control->id);  // success shows when the value is read back
    }
    append(problems, apply_one(name, value));
  }
  return problems;
}

std::string CameraControls::apply_one(const std::string& name, std::int32_t value) {
  const DeviceControl* control = find(name);
  if (control == nullptr) return "no control named " + name;
  const std::string range =
      " (range " + std::to_string(control->minimum) + "…" + std::to_string(control->maximum) + ")";
  const std::string wanted = std::to_string(value);
  if (const int error = device_.set_control(control->id, value)) {
    return name + ": cannot be set to " + wanted + ": " + std::strerror(error) + range;
  }
  std::int32_t actual = 0;
  if (const int error = device_.get_control(control->id, actual)) {
    return name + ": set to " + wanted + ", cannot be read back: " + std::strerror(error);
  }
  if (actual == value) return "";
  return name + ": set to " + wanted + ", reads back " + std::to_string(actual) + range;
}

}  // namespace stereod::v4l2
