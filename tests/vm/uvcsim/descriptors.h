// SPDX-License-Identifier: BSD-3-Clause
// The simulated camera's descriptors (USB 2.0 chapter 9, USB Video Class 1.0 chapter 3).
#pragma once

#include <string>

#include "tests/vm/uvcsim/bytes.h"

namespace stereod::uvcsim {

/// The endpoint of the image stream.
constexpr std::uint8_t kStreamEndpoint = 1;
/// Numbers of the interfaces and of the units with controls.
constexpr std::uint8_t kControlInterface = 0, kStreamInterface = 1;
constexpr std::uint8_t kCameraUnit = 1, kProcessingUnit = 2;

Bytes device_descriptor();
/// Returns the configuration with all its interfaces: a camera, its processing unit and a bulk stream.
Bytes configuration_descriptor();
/// Returns string @p number: 0 = list of languages, 1 = manufacturer, 2 = product, 3 = @p serial (ASCII).
Bytes string_descriptor(int number, const std::string& serial);

}  // namespace stereod::uvcsim
