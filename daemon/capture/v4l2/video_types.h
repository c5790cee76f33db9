// SPDX-License-Identifier: BSD-3-Clause
// V4L2's answers in the daemon's own types.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/image.h"

namespace stereod::v4l2 {

/// Returns the four letters that name a pixel format as V4L2 writes them in a number.
constexpr std::uint32_t make_fourcc(char a, char b, char c, char d) {
  const auto byte = [](char letter) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(letter));
  };
  return byte(a) | byte(b) << 8 | byte(c) << 16 | byte(d) << 24;
}
/// Returns the letters of @p fourcc, such as "YUYV". An unprintable byte becomes '?'; spaces at the end are
/// cut off.
std::string fourcc_name(std::uint32_t fourcc);

struct DeviceCapability {
  std::string card;       ///< the camera's name
  std::string bus;        ///< where it is plugged in: usb-0000:00:14.0-3
  bool captures = false;  ///< captures images; a UVC camera's metadata node does not
  bool streams = false;   ///< streams into mapped buffers
};

/// How images lie in a buffer.
struct DeviceFormat {
  std::uint32_t fourcc = 0;
  Size size;                         ///< [px]
  std::uint32_t bytes_per_line = 0;  ///< 0 = no padding
  std::uint32_t image_bytes = 0;
  friend bool operator==(const DeviceFormat&, const DeviceFormat&) = default;
};

/// A buffer that the driver has filled.
struct FilledBuffer {
  std::uint32_t index = 0;
  std::uint32_t bytes = 0;
  std::uint32_t sequence = 0;
  std::int64_t timestamp_ns = 0;
  bool error = false;                ///< the driver marked the image as damaged
  bool timestamp_monotonic = false;  ///< the timestamp is CLOCK_MONOTONIC; else its clock is unknown
  bool timestamp_start = false;      ///< the timestamp is the start of exposure; else the end of the frame
};

/// An integer, boolean or menu control.
struct DeviceControl {
  std::uint32_t id = 0;  ///< V4L2_CID_*
  std::string name;      ///< exposure_time_absolute
  std::int32_t minimum = 0, maximum = 0, step = 1, default_value = 0;
  bool writable = true;
};

/// The frame rates that a driver lists.
struct OfferedRates {
  std::vector<double> listed;  ///< [Hz], fastest first; empty if the driver lists none
  bool range = false;          ///< `listed` holds the two ends of a range
};

}  // namespace stereod::v4l2
