// SPDX-License-Identifier: BSD-3-Clause
// Requests to controls, and automatic exposure.
#include "tests/vm/uvcsim/controls.h"

#include <algorithm>

#include "tests/vm/uvcsim/descriptors.h"

namespace stereod::uvcsim {
namespace {

// Selectors (USB Video Class 1.0, A.9.4 and A.9.5).
constexpr std::uint8_t kExposureMode = 2, kExposurePriority = 3, kExposureTime = 4;
constexpr std::uint8_t kBrightness = 2, kGain = 4, kPowerLine = 5, kWhiteBalance = 10, kWhiteBalanceAuto = 11;

constexpr std::int32_t kManual = 1, kAperturePriority = 8;  // values of the exposure mode
constexpr std::int32_t kUsualTime = 156;                    // 100 µs
constexpr std::uint8_t kWrongState = 4, kNoSuchControl = 6;
constexpr int kReadable = 1, kWritable = 2, kOverruled = 4, kChanges = 8;  // bits of GET_INFO (4.1.2)

Bytes number(std::int32_t value, int length) {
  Bytes bytes;
  put_little(bytes, static_cast<std::uint32_t>(value), length);
  return bytes;
}

std::int32_t read_number(ByteSpan data, std::uint8_t length, bool may_be_negative) {
  const std::uint32_t value = get_little(data, 0, length);
  return may_be_negative ? static_cast<std::int16_t>(value) : static_cast<std::int32_t>(value);
}

}  // namespace

Controls::Controls()
    : controls_{{{kCameraUnit, kExposureMode, 1, kManual, kAperturePriority, kManual | kAperturePriority,
                  kAperturePriority, kAperturePriority},
                 {kCameraUnit, kExposurePriority, 1, 0, 1, 1, 0, 0},
                 {kCameraUnit, kExposureTime, 4, 1, 5000, 1, kUsualTime, kUsualTime},
                 {kProcessingUnit, kBrightness, 2, -64, 64, 1, 0, 0},
                 {kProcessingUnit, kGain, 2, 0, 255, 1, 0, 0},
                 {kProcessingUnit, kPowerLine, 1, 0, 2, 1, 1, 1},
                 {kProcessingUnit, kWhiteBalance, 2, 2800, 6500, 1, 4600, 4600},
                 {kProcessingUnit, kWhiteBalanceAuto, 1, 0, 1, 1, 1, 1}}} {}

const Controls::Control& Controls::find(std::uint8_t unit, std::uint8_t selector) const {
  return *std::find_if(controls_.begin(), controls_.end(),
                       [=](const Control& c) { return c.unit == unit && c.selector == selector; });
}

bool Controls::automatic(const Control& control) const {
  if (control.unit == kCameraUnit && control.selector == kExposureTime) {
    return find(kCameraUnit, kExposureMode).value != kManual;
  }
  return control.unit == kProcessingUnit && control.selector == kWhiteBalance &&
         find(kProcessingUnit, kWhiteBalanceAuto).value != 0;
}

std::optional<Bytes> Controls::answer(ControlRequest request, std::uint8_t unit, std::uint8_t selector,
                                      ByteSpan data) {
  const auto control = std::find_if(controls_.begin(), controls_.end(), [=](const Control& c) {
    return c.unit == unit && c.selector == selector;
  });
  error_code_ = control == controls_.end() ? kNoSuchControl : 0;
  if (error_code_ != 0) return std::nullopt;
  switch (request) {
    case ControlRequest::kSetCurrent:
      if (automatic(*control)) {
        error_code_ = kWrongState;
        return std::nullopt;
      }
      control->value = std::clamp(read_number(data, control->length, control->minimum < 0), control->minimum,
                                  control->maximum);
      expose_automatically();
      return Bytes{};
    case ControlRequest::kGetCurrent:
      return number(control->value, control->length);
    case ControlRequest::kGetMinimum:
      return number(control->minimum, control->length);
    case ControlRequest::kGetMaximum:
      return number(control->maximum, control->length);
    case ControlRequest::kGetResolution:
      return number(control->resolution, control->length);
    case ControlRequest::kGetDefault:
      return number(control->usual, control->length);
    case ControlRequest::kGetLength:
      return number(control->length, 2);
    case ControlRequest::kGetInfo: {
      // The host reads a control only once unless its information has the bit for automatic changes.
      const bool changes = control->unit == kCameraUnit && control->selector == kExposureTime;
      return number(kReadable | kWritable | (automatic(*control) ? kOverruled : 0) | (changes ? kChanges : 0),
                    1);
    }
  }
  error_code_ = kNoSuchControl;
  return std::nullopt;
}

void Controls::set_light(int percent) {
  light_percent_ = std::max(percent, 1);
  expose_automatically();
}

// Sets the exposure time that compensates light and gain.
void Controls::expose_automatically() {
  for (Control& control : controls_) {
    if (control.unit != kCameraUnit || control.selector != kExposureTime || !automatic(control)) continue;
    const int gain = 64 + find(kProcessingUnit, kGain).value;
    control.value =
        std::clamp(kUsualTime * 100 / light_percent_ * 64 / gain, control.minimum, control.maximum);
  }
}

int Controls::gain_64() const {
  const int time = find(kCameraUnit, kExposureTime).value;
  const int gain = 64 + find(kProcessingUnit, kGain).value;
  return time * gain / kUsualTime * light_percent_ / 100;
}

int Controls::offset() const { return find(kProcessingUnit, kBrightness).value; }

}  // namespace stereod::uvcsim
