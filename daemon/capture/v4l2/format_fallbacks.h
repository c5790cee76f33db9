// Which format and rate a camera is asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/capture/v4l2/pixel_format.h"

namespace stereod {

/// A format that a camera offers at the wanted size.
struct OfferedFormat {
  std::uint32_t pixels = 0;
  OfferedRates rates;
  /// 0: it does not say.
  double fastest() const { return rates.listed.empty() ? 0 : rates.listed.front(); }
};

struct FormatRequest {
  std::uint32_t pixels = 0;  ///< what is asked of the driver, or of libv4l2
  double fps = 0;
  bool convert = false;  ///< through libv4l2
};

/// Every request worth trying, the best first. `name`: auto or a format's name. For auto: the uncompressed
/// format that puts the least on the bus, then MJPEG, then two lower rates that it offers, each by a third or
/// more lower than the one before (a half and a quarter, where it offers any) and none below 5 a second; a
/// format that reaches the rate comes before one that does not. What is not read here goes through libv4l2,
/// after all others. For a name there is one request. Empty: nothing fits.
std::vector<FormatRequest> format_ladder(const std::vector<OfferedFormat>& offers, const std::string& name,
                                         double fps);

}  // namespace stereod
