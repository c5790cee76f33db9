// How image_t names its pixel formats: bot_core's numbers, which are V4L2's four letters.
#pragma once

#include <cstdint>

namespace stereod {

inline constexpr std::int32_t kPixelFormatGray = 1'497'715'271;   ///< "GREY": 8 bit, PIXEL_FORMAT_GRAY
inline constexpr std::int32_t kPixelFormatMjpeg = 1'196'444'237;  ///< "MJPG": one JPEG, PIXEL_FORMAT_MJPEG

}  // namespace stereod
