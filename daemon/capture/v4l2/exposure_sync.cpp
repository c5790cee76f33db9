// SPDX-License-Identifier: BSD-3-Clause
// Exposure of two cameras.
#include "daemon/capture/v4l2/exposure_sync.h"

#include <linux/v4l2-controls.h>

#include <utility>

namespace stereod::v4l2 {

void ExposureSync::configure(VideoDevice& device, std::int64_t now_ns) {
  CameraControls controls(device);
  if (is_outdated()) adopt_configuration(controls);
  const ControlValues values = configured_values();
  bool priority_named = false, time_named = false, gain_named = false;
  for (const auto& [name, value] : values) {
    const DeviceControl* control = controls.find(name);
    if (control == nullptr) continue;
    priority_named = priority_named || control->id == V4L2_CID_EXPOSURE_AUTO_PRIORITY;
    time_named = time_named || control->id == V4L2_CID_EXPOSURE_ABSOLUTE;
    gain_named = gain_named || control->id == V4L2_CID_GAIN;
  }
  if (!priority_named && controls.find(V4L2_CID_EXPOSURE_AUTO_PRIORITY) != nullptr) {
    device.set_control(V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);
  }
  has_time_ = !time_named && controls.find(V4L2_CID_EXPOSURE_ABSOLUTE) != nullptr;
  has_gain_ = !gain_named && controls.find(V4L2_CID_GAIN) != nullptr;
  has_time_mode_ = !time_named && controls.find(V4L2_CID_EXPOSURE_AUTO) != nullptr;
  has_gain_mode_ = !gain_named && controls.find(V4L2_CID_AUTOGAIN) != nullptr;
  applied_.reset();
  manual_ = false;
  differing_ = false;
  next_update_ns_ = now_ns + kUpdatePeriod;
  settled_ns_ = now_ns + kSettlingTime;
  const bool leads = side_ == Side::kLeft && config_.exposure != ExposureMode::kAuto;
  const bool settled = config_.exposure == ExposureMode::kLock && pair_.exposure();
  // Another program may have left the automatic modes off.
  if (leads && !settled) {
    if (has_time_mode_) controls.reset(V4L2_CID_EXPOSURE_AUTO);
    if (has_gain_mode_) controls.reset(V4L2_CID_AUTOGAIN);
  }
  control_problems_ = controls.apply(values);
  if (config_.exposure != ExposureMode::kAuto && controls.find(V4L2_CID_EXPOSURE_ABSOLUTE) == nullptr) {
    control_problems_ += std::string(control_problems_.empty() ? "" : "; ") +
                         "no control named exposure_time_absolute, so the cameras cannot be exposed alike";
  }
  std::int32_t time = 0;
  // With lock and follow the exposure is about to change.
  const bool known = config_.exposure == ExposureMode::kAuto &&
                     device.get_control(V4L2_CID_EXPOSURE_ABSOLUTE, time) == 0 && time > 0;
  exposure_ns_ = known ? std::int64_t{time} * 100'000 : 0;
}

// The values for both cameras, overridden by those for this camera.
ControlValues ExposureSync::configured_values() const {
  ControlValues values = config_.controls;
  const ControlValues& own = side_ == Side::kLeft ? config_.left_controls : config_.right_controls;
  for (const auto& [name, value] : own) values[name] = value;
  return values;
}

void ExposureSync::adopt_configuration(CameraControls& controls) {
  const ControlValues before = configured_values();
  const ExposureMode mode_before = config_.exposure;
  config_ = pair_.controls(controls_number_);
  const ControlValues now = configured_values();
  for (const auto& [name, value] : before) {
    const DeviceControl* control = controls.find(name);
    if (control != nullptr && now.count(name) == 0) controls.reset(control->id);
  }
  if (mode_before != ExposureMode::kAuto && config_.exposure == ExposureMode::kAuto) {
    controls.reset(V4L2_CID_EXPOSURE_AUTO);
    controls.reset(V4L2_CID_AUTOGAIN);
  }
}

bool ExposureSync::update(VideoDevice& device, std::int64_t now_ns) noexcept {
  if (config_.exposure == ExposureMode::kAuto || now_ns < next_update_ns_) return false;
  if (!has_time_ && !has_gain_) return false;
  next_update_ns_ = now_ns + kUpdatePeriod;
  const bool lock = config_.exposure == ExposureMode::kLock;
  const std::optional<ExposureValues> wanted = pair_.exposure();
  if (side_ == Side::kLeft && (!lock || !wanted)) {
    if (!lock || now_ns >= settled_ns_) share(read(device));
    return false;
  }
  if (!wanted) return false;
  const bool fixed = manual_ && applied_ == wanted;
  if (fixed) actual_ = read(device);  // another program may have changed it
  if (!fixed || differs(*wanted)) apply(device, *wanted);
  const bool different = differs(*wanted);
  return std::exchange(differing_, different) != different;
}

bool ExposureSync::differs(const ExposureValues& wanted) const noexcept {
  return (wanted.time && wanted.time != actual_.time) || (wanted.gain && wanted.gain != actual_.gain);
}

// A control that could not be read is read again at the next update.
void ExposureSync::share(const ExposureValues& values) noexcept {
  if ((has_time_ && !values.time) || (has_gain_ && !values.gain)) return;
  pair_.set_exposure(values);
}

ExposureValues ExposureSync::read(VideoDevice& device) noexcept {
  ExposureValues values;
  std::int32_t value = 0;
  if (has_time_ && device.get_control(V4L2_CID_EXPOSURE_ABSOLUTE, value) == 0) values.time = value;
  if (has_gain_ && device.get_control(V4L2_CID_GAIN, value) == 0) values.gain = value;
  return values;
}

void ExposureSync::apply(VideoDevice& device, const ExposureValues& values) noexcept {
  if (!manual_) manual_ = disable_auto_modes(device);
  if (has_time_ && values.time) device.set_control(V4L2_CID_EXPOSURE_ABSOLUTE, *values.time);
  if (has_gain_ && values.gain) device.set_control(V4L2_CID_GAIN, *values.gain);
  applied_ = values;
  actual_ = read(device);
}

bool ExposureSync::disable_auto_modes(VideoDevice& device) noexcept {
  const bool time = !has_time_mode_ || device.set_control(V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL) == 0;
  const bool gain = !has_gain_mode_ || device.set_control(V4L2_CID_AUTOGAIN, 0) == 0;
  return time && gain;
}

std::string ExposureSync::note() const {
  if (!differing_) return control_problems_;
  return control_problems_ + (control_problems_.empty() ? "" : "; ") + difference();
}

std::string ExposureSync::difference() const {
  std::string text = "the exposure differs from the left camera's:";
  const auto add = [&](const char* name, std::optional<std::int32_t> wanted,
                       std::optional<std::int32_t> actual) {
    if (!wanted || wanted == actual) return;
    if (text.back() != ':') text += ",";
    text += std::string(" ") + name + " is " + (actual ? std::to_string(*actual) : "unreadable") +
            ", should be " + std::to_string(*wanted);
  };
  add("exposure_time_absolute", applied_->time, actual_.time);
  add("gain", applied_->gain, actual_.gain);
  return text;
}

}  // namespace stereod::v4l2
