#include "daemon/capture/v4l2/exposure_keeper.h"

#include <linux/v4l2-controls.h>

#include <utility>

namespace stereod {

std::string ExposureKeeper::begin(VideoDevice& device, std::int64_t now_ns) {
  CameraControls controls(device);
  if (outdated()) take_controls(controls);
  const ControlValues values = this->values();
  bool priority_named = false;
  fixed_by_config_ = false;
  for (const auto& [name, value] : values) {
    const DeviceControl* control = controls.find(name);
    if (control == nullptr) continue;
    priority_named = priority_named || control->id == V4L2_CID_EXPOSURE_AUTO_PRIORITY;
    fixed_by_config_ = fixed_by_config_ || control->id == V4L2_CID_EXPOSURE_ABSOLUTE;
  }
  if (!priority_named && controls.find(V4L2_CID_EXPOSURE_AUTO_PRIORITY) != nullptr) {
    device.set_control(V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);
  }
  has_time_ = controls.find(V4L2_CID_EXPOSURE_ABSOLUTE) != nullptr;
  has_gain_ = controls.find(V4L2_CID_GAIN) != nullptr;
  has_time_mode_ = controls.find(V4L2_CID_EXPOSURE_AUTO) != nullptr;
  has_gain_mode_ = controls.find(V4L2_CID_AUTOGAIN) != nullptr;
  applied_.reset();
  manual_ = false;
  told_ = false;
  next_ns_ = now_ns + kPeriod;
  settled_ns_ = now_ns + kSettle;
  const bool leads = side_ == Side::kLeft && config_.exposure != ExposureMode::kAuto && !fixed_by_config_;
  const bool settled = config_.exposure == ExposureMode::kLock && pair_.exposure();
  // Whoever had the camera before may have left its automatic modes off.
  if (leads && !settled) {
    for (const std::uint32_t mode : {V4L2_CID_EXPOSURE_AUTO, V4L2_CID_AUTOGAIN}) {
      const DeviceControl* control = controls.find(mode);
      if (control != nullptr) device.set_control(mode, control->preset);
    }
  }
  const std::string complaints = controls.apply(values);
  const std::int64_t time = read(device).time.value_or(0);
  exposure_ns_ = time > 0 ? time * 100'000 : 0;
  return complaints;
}

// Of both cameras, and what this one has for itself.
ControlValues ExposureKeeper::values() const {
  ControlValues values = config_.controls;
  const ControlValues& own = side_ == Side::kLeft ? config_.left_controls : config_.right_controls;
  for (const auto& [name, value] : own) values[name] = value;
  return values;
}

void ExposureKeeper::take_controls(CameraControls& controls) {
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

bool ExposureKeeper::tick(VideoDevice& device, std::int64_t now_ns) noexcept {
  if (config_.exposure == ExposureMode::kAuto || fixed_by_config_ || now_ns < next_ns_) return false;
  if (!has_time_ && !has_gain_) return false;
  next_ns_ = now_ns + kPeriod;
  const bool lock = config_.exposure == ExposureMode::kLock;
  const std::optional<ExposureValues> wanted = pair_.exposure();
  if (side_ == Side::kLeft && (!lock || !wanted)) {
    if (!lock || now_ns >= settled_ns_) offer(read(device));
    return false;
  }
  if (!wanted || (manual_ && applied_ == wanted && got_ == *wanted)) return false;
  fix(device, *wanted);
  return got_ != *wanted && !std::exchange(told_, true);
}

// What could not be read this time will be the next.
void ExposureKeeper::offer(const ExposureValues& values) noexcept {
  if ((has_time_ && !values.time) || (has_gain_ && !values.gain)) return;
  pair_.set_exposure(values);
}

ExposureValues ExposureKeeper::read(VideoDevice& device) noexcept {
  ExposureValues values;
  std::int32_t value = 0;
  if (has_time_ && device.get_control(V4L2_CID_EXPOSURE_ABSOLUTE, value) == 0) values.time = value;
  if (has_gain_ && device.get_control(V4L2_CID_GAIN, value) == 0) values.gain = value;
  return values;
}

void ExposureKeeper::fix(VideoDevice& device, const ExposureValues& values) noexcept {
  if (!manual_) manual_ = go_manual(device);
  if (has_time_ && values.time) device.set_control(V4L2_CID_EXPOSURE_ABSOLUTE, *values.time);
  if (has_gain_ && values.gain) device.set_control(V4L2_CID_GAIN, *values.gain);
  applied_ = values;
  got_ = read(device);
}

bool ExposureKeeper::go_manual(VideoDevice& device) noexcept {
  const bool time = !has_time_mode_ || device.set_control(V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL) == 0;
  const bool gain = !has_gain_mode_ || device.set_control(V4L2_CID_AUTOGAIN, 0) == 0;
  return time && gain;
}

std::string ExposureKeeper::problem() const {
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
