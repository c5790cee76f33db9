// SPDX-License-Identifier: BSD-3-Clause
// The simulated camera's controls and their effect on the image.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tests/vm/uvcsim/bytes.h"

namespace stereod::uvcsim {

/// Class-specific requests (USB Video Class 1.0, table A-8).
enum class ControlRequest : std::uint8_t {
  kSetCurrent = 0x01,
  kGetCurrent = 0x81,
  kGetMinimum = 0x82,
  kGetMaximum = 0x83,
  kGetResolution = 0x84,
  kGetLength = 0x85,
  kGetInfo = 0x86,
  kGetDefault = 0x87,
};

/// Exposure, gain, brightness, white balance and power line frequency.
class Controls {
 public:
  Controls();

  /// Answers a request to a unit's control. Returns nothing if the request is refused; error_code() tells
  /// why.
  std::optional<Bytes> answer(ControlRequest request, std::uint8_t unit, std::uint8_t selector,
                              ByteSpan data);

  /// Returns why the last request was refused (USB Video Class 1.5, table 4-7): 0 = not refused, 4 = wrong
  /// state, 6 = no such control.
  std::uint8_t error_code() const { return error_code_; }

  /// Sets the light on the scene [% of the light that suits the defaults]. Automatic exposure follows it.
  void set_light(int percent);

  /// Return the factor of the scene's brightness [1/64] and its offset.
  int gain_64() const;
  int offset() const;

 private:
  struct Control {
    std::uint8_t unit, selector, length;
    std::int32_t minimum, maximum, resolution, usual;
    std::int32_t value;
  };
  static constexpr std::size_t kCount = 8;

  const Control& find(std::uint8_t unit, std::uint8_t selector) const;
  bool automatic(const Control& control) const;
  void expose_automatically();

  std::array<Control, kCount> controls_;
  int light_percent_ = 100;
  std::uint8_t error_code_ = 0;
};

}  // namespace stereod::uvcsim
