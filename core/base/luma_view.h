// SPDX-License-Identifier: BSD-3-Clause
// 8-bit luma that is owned elsewhere.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/image.h"

namespace stereod {

/// The luma of an image, read in place. `pixel_stride` is 1 for gray and planar formats and 2 for the Y of
/// YUYV and UYVY.
struct LumaView {
  const std::uint8_t* data = nullptr;
  Size size;                        ///< [px]
  std::ptrdiff_t row_stride = 0;    ///< [bytes]
  std::ptrdiff_t pixel_stride = 1;  ///< [bytes]
};

}  // namespace stereod
