#include "daemon/capture/v4l2/exposure_sync.h"

#include <linux/v4l2-controls.h>

#include <utility>

namespace stereod {

void ExposureSync::begin(VideoDevice& device, std::int64_t now_ns) {
  CameraControls controls(device);
  if (outdated()) take_controls(controls);
  const ControlValues values = this->values();
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
  told_ = false;
  next_ns_ = now_ns + kPeriod;
  settled_ns_ = now_ns + kSettle;
  const bool leads = side_ == Side::kLeft && config_.exposure != ExposureMode::kAuto;
  const bool settled = config_.exposure == ExposureMode::kLock && pair_.exposure();
  // Whoever had the camera before may have left its automatic modes off.
  if (leads && !settled) {
    if (has_time_mode_) controls.reset(V4L2_CID_EXPOSURE_AUTO);
    if (has_gain_mode_) controls.reset(V4L2_CID_AUTOGAIN);
  }
  complaints_ = controls.apply(values);
  if (config_.exposure != ExposureMode::kAuto && controls.find(V4L2_CID_EXPOSURE_ABSOLUTE) == nullptr) {
    complaints_ += std::string(complaints_.empty() ? "" : "; ") +
                   "it has no exposure_time_absolute, so both cameras cannot be exposed alike";
  }
  std::int32_t time = 0;
  // Where both cameras are brought to one exposure, what it is now will not be what it is then.
  const bool known = config_.exposure == ExposureMode::kAuto &&
                     device.get_control(V4L2_CID_EXPOSURE_ABSOLUTE, time) == 0 && time > 0;
  exposure_ns_ = known ? std::int64_t{time} * 100'000 : 0;
}

// Of both cameras, and what this one has for itself.
ControlValues ExposureSync::values() const {
  ControlValues values = config_.controls;
  const ControlValues& own = side_ == Side::kLeft ? config_.left_controls : config_.right_controls;
  for (const auto& [name, value] : own) values[name] = value;
  return values;
}

void ExposureSync::take_controls(CameraControls& controls) {
  const ControlValues before = values();
  const ExposureMode mode_before = config_.exposure;
  config_ = pair_.controls(controls_number_);
  const ControlValues now = values();
  for (const auto& [name, value] : before) {
    const DeviceControl* control = controls.find(name);
    if (control != nullptr && now.count(name) == 0) controls.reset(control->id);
  }
  if (mode_before != ExposureMode::kAuto && config_.exposure == ExposureMode::kAuto) {
    controls.reset(V4L2_CID_EXPOSURE_AUTO);
    controls.reset(V4L2_CID_AUTOGAIN);
  }
}

bool ExposureSync::tick(VideoDevice& device, std::int64_t now_ns) noexcept {
  if (config_.exposure == ExposureMode::kAuto || now_ns < next_ns_) return false;
  if (!has_time_ && !has_gain_) return false;
  next_ns_ = now_ns + kPeriod;
  const bool lock = config_.exposure == ExposureMode::kLock;
  const std::optional<ExposureValues> wanted = pair_.exposure();
  if (side_ == Side::kLeft && (!lock || !wanted)) {
    if (!lock || now_ns >= settled_ns_) offer(read(device));
    return false;
  }
  if (!wanted) return false;
  const bool fixed = manual_ && applied_ == wanted;
  if (fixed) got_ = read(device);  // somebody else may have changed it
  if (!fixed || differs(*wanted)) fix(device, *wanted);
  const bool different = differs(*wanted);
  return std::exchange(told_, different) != different;
}

bool ExposureSync::differs(const ExposureValues& wanted) const noexcept {
  return (wanted.time && wanted.time != got_.time) || (wanted.gain && wanted.gain != got_.gain);
}

// What could not be read this time will be the next.
void ExposureSync::offer(const ExposureValues& values) noexcept {
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

void ExposureSync::fix(VideoDevice& device, const ExposureValues& values) noexcept {
  if (!manual_) manual_ = go_manual(device);
  if (has_time_ && values.time) device.set_control(V4L2_CID_EXPOSURE_ABSOLUTE, *values.time);
  if (has_gain_ && values.gain) device.set_control(V4L2_CID_GAIN, *values.gain);
  applied_ = values;
  got_ = read(device);
}

bool ExposureSync::go_manual(VideoDevice& device) noexcept {
  const bool time = !has_time_mode_ || device.set_control(V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL) == 0;
  const bool gain = !has_gain_mode_ || device.set_control(V4L2_CID_AUTOGAIN, 0) == 0;
  return time && gain;
}

std::string ExposureSync::note() const {
  if (!told_) return complaints_;
  return complaints_ + (complaints_.empty() ? "" : "; ") + problem();
}

std::string ExposureSync::problem() const {
  std::string text = "its exposure does not take the left camera's values:";
  const auto add = [&](const char* name, std::optional<std::int32_t> wanted,
                       std::optional<std::int32_t> got) {
    if (!wanted || wanted == got) return;
    text += std::string(" ") + name + " should be " + std::to_string(*wanted) + " and is " +
            (got ? std::to_string(*got) : "missing");
  };
  add("exposure_time_absolute", applied_->time, got_.time);
  add("gain", applied_->gain, got_.gain);
  return text;
}

}  // namespace stereod
