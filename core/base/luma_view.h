// SPDX-License-Identifier: BSD-3-Clause
// The brightness of an image, read in place.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/image.h"

namespace stereod {

/// Borrows the luma samples of an image. `pixel_stride` is 1 for gray and planar formats, 2 for the Y of YUYV
/// and UYVY. Valid as long as the memory behind it.
struct LumaView {
  const std::uint8_t* data = nullptr;
  Size size;                        ///< [px]
  std::ptrdiff_t row_stride = 0;    ///< from row to row [bytes]
  std::ptrdiff_t pixel_stride = 1;  ///< from pixel to pixel [bytes]
};

}  // namespace stereod
