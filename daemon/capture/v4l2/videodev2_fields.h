// SPDX-License-Identifier: BSD-3-Clause
// Conversions of fields of <linux/videodev2.h>; for the sources of VideoDevice only.
#pragma once

#include <linux/videodev2.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace stereod::v4l2 {

/// Returns the text of a fixed-size field, with control characters replaced: it comes from the device and
/// goes to terminals and logs.
inline std::string text_of(const __u8* field, std::size_t size) {
  const char* text = reinterpret_cast<const char*>(field);
  std::string name(text, strnlen(text, size));
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  std::replace_if(name.begin(), name.end(), is_control, '?');
  return name;
}

/// Returns the rate [Hz] of a frame interval; 0 if the interval is 0.
inline double rate_of(const v4l2_fract& interval) {
  return interval.numerator > 0 ? static_cast<double>(interval.denominator) / interval.numerator : 0;
}

}  // namespace stereod::v4l2
