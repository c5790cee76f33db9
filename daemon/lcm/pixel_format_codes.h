// SPDX-License-Identifier: BSD-3-Clause
// Pixel formats of image_t: the numbers of bot_core, which are V4L2's four-character codes.
#pragma once

#include <cstdint>

namespace stereod {

inline constexpr std::int32_t kPixelFormatGray = 1'497'715'271;   ///< "GREY": 8 bits per pixel
inline constexpr std::int32_t kPixelFormatMjpeg = 1'196'444'237;  ///< "MJPG": a JPEG file

}  // namespace stereod
