// SPDX-License-Identifier: BSD-3-Clause
// Which formats and rates a camera is asked for, in which order.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/capture/v4l2/pixel_format.h"

namespace stereod::v4l2 {

/// A format that a camera offers at the configured size.
struct OfferedFormat {
  std::uint32_t fourcc = 0;
  OfferedRates rates;
  /// Returns the highest rate [Hz]; 0 if the driver lists none.
  double fastest() const { return rates.listed.empty() ? 0 : rates.listed.front(); }
};

struct FormatRequest {
  std::uint32_t fourcc = 0;  ///< requested of the driver, or of libv4l2
  double fps = 0;            ///< [Hz]
  bool convert = false;      ///< through libv4l2
};

/// Returns the requests for a camera, best first; the index is the fallback level. Empty if no offer fits.
///
/// @p name: a format's name gives that format only. "auto" gives, in this order:
///   1. the uncompressed format with the lowest traffic on the bus,
///   2. MJPEG,
///   3. up to two lower rates that the camera offers, each at most 0.68 × the previous one (a half and a
///      quarter if the camera offers any rate), not below 5 Hz.
/// A format that reaches @p fps precedes a format that does not. If the daemon reads none of the formats,
/// libv4l2 converts the first one to YU12, with the same lower rates.
std::vector<FormatRequest> format_fallbacks(const std::vector<OfferedFormat>& offers, const std::string& name,
                                            double fps);

}  // namespace stereod::v4l2
