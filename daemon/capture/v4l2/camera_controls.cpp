#include "daemon/capture/v4l2/camera_controls.h"

#include <linux/v4l2-controls.h>

#include <algorithm>
#include <cstring>

namespace stereod {
namespace {

/// A control, the automatic mode that sets it too, and the mode's value for "off".
struct Automatic {
  std::uint32_t value, mode;
  std::int32_t off;
};
constexpr Automatic kAutomatic[] = {
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

/// The kernel has renamed some controls (in 5.18); both names are understood.
struct Name {
  const char* name;
  std::uint32_t id;
};
constexpr Name kNames[] = {
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
  return std::any_of(std::begin(kAutomatic), std::end(kAutomatic),
                     [&](const Automatic& automatic) { return automatic.mode == id; });
}

void add_sentence(std::string& text, const std::string& sentence) {
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
  for (const Name& known : kNames) {
    if (known.name == name) return find(known.id);
  }
  return nullptr;
}

int CameraControls::switch_off_automatic(std::uint32_t id) {
  for (const Automatic& automatic : kAutomatic) {
    if (automatic.value != id || find(automatic.mode) == nullptr) continue;
    if (const int error = device_.set_control(automatic.mode, automatic.off)) return error;
  }
  return 0;
}

void CameraControls::reset(std::uint32_t id) {
  const DeviceControl* control = find(id);
  if (control == nullptr) return;
  // The value first: an automatic mode may overrule it.
  device_.set_control(id, control->preset);
  for (const Automatic& automatic : kAutomatic) {
    const DeviceControl* mode = automatic.value == id ? find(automatic.mode) : nullptr;
    if (mode != nullptr) device_.set_control(mode->id, mode->preset);
  }
}

std::string CameraControls::apply(const ControlValues& values) {
  std::string complaints;
  std::vector<std::uint32_t> named_modes;
  // Modes first: a value that a mode overrules is lost.
  for (const auto& [name, value] : values) {
    const DeviceControl* control = find(name);
    if (control == nullptr || !is_mode(control->id)) continue;
    named_modes.push_back(control->id);
    add_sentence(complaints, apply_one(name, value));
  }
  for (const auto& [name, value] : values) {
    const DeviceControl* control = find(name);
    if (control != nullptr && is_mode(control->id)) continue;
    if (control != nullptr) {
      const bool named =
          std::any_of(std::begin(kAutomatic), std::end(kAutomatic), [&](const Automatic& automatic) {
            return automatic.value == control->id &&
                   std::find(named_modes.begin(), named_modes.end(), automatic.mode) != named_modes.end();
          });
      if (!named) switch_off_automatic(control->id);  // what comes of it shows when the value is read back
    }
    add_sentence(complaints, apply_one(name, value));
  }
  return complaints;
}

std::string CameraControls::apply_one(const std::string& name, std::int32_t value) {
  const DeviceControl* control = find(name);
  if (control == nullptr) return "it has no control " + name;
  const std::string range =
      ", allowed are " + std::to_string(control->least) + " to " + std::to_string(control->most);
  if (const int error = device_.set_control(control->id, value)) {
    return name + " could not be set to " + std::to_string(value) + " (" + std::strerror(error) + ")" +
           range;  // NOLINT(concurrency-mt-unsafe)
  }
  std::int32_t got = 0;
  if (const int error = device_.get_control(control->id, got)) {
    return name + " was set to " + std::to_string(value) + " and cannot be read back (" +
           std::strerror(error) + ")";  // NOLINT(concurrency-mt-unsafe)
  }
  if (got == value) return "";
  return name + " was set to " + std::to_string(value) + " and is " + std::to_string(got) + range;
}

}  // namespace stereod
