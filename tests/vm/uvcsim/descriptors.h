// What the simulated camera tells the host that it is (USB 2.0 chapter 9, USB Video Class 1.0 chapter 3).
#pragma once

#include <string>

#include "tests/vm/uvcsim/bytes.h"

namespace stereod::uvcsim {

/// The endpoint that images come from.
constexpr std::uint8_t kStreamEndpoint = 1;
/// The numbers of the interfaces, and of the units that have controls.
constexpr std::uint8_t kControlInterface = 0, kStreamInterface = 1;
constexpr std::uint8_t kCameraUnit = 1, kProcessingUnit = 2;

Bytes device_descriptor();
/// The configuration with all its interfaces: a camera, its processing unit and a bulk stream.
Bytes configuration_descriptor();
/// String `number`: 1 manufacturer, 2 product, 3 `serial` (ASCII); 0 is the list of languages.
Bytes string_descriptor(int number, const std::string& serial);

}  // namespace stereod::uvcsim
