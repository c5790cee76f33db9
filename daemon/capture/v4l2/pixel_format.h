// SPDX-License-Identifier: BSD-3-Clause
// Where the luma lies in each pixel format that the daemon reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/luma_view.h"
#include "daemon/capture/v4l2/video_types.h"

namespace stereod::v4l2 {

/// How a buffer becomes 8-bit luma.
enum class LumaWork {
  kNone,   ///< the luma is read in place
  kScale,  ///< 16-bit words with 10 significant bits
  kJpeg,   ///< each buffer is a JPEG file
};

struct PixelFormat {
  std::uint32_t fourcc = 0;
  std::string_view name;  ///< as in the configuration
  LumaWork work = LumaWork::kNone;
  int bytes_per_pixel = 1;  ///< [bytes] in the rows that hold the luma
  int luma_offset = 0;      ///< [bytes] of the first pixel's luma in its row
  double traffic = 1;       ///< [bytes per pixel] on the bus; 0 = compressed
};

/// Returns the format with this fourcc or this name (gray, nv12, yu12, yuyv, uyvy, y10, y16, mjpeg), null if
/// the daemon does not read it.
const PixelFormat* find_pixel_format(std::uint32_t fourcc);
const PixelFormat* find_pixel_format(std::string_view name);
/// Returns all formats, sorted by traffic on the bus; compressed formats last.
std::span<const PixelFormat> pixel_formats();

/// Returns the distance between rows [bytes]. A driver that reports 0 bytes per line pads nothing.
std::size_t row_stride(const PixelFormat& format, const DeviceFormat& device);

/// Returns the minimum size of a buffer that holds the whole luma [bytes]; 0 for JPEG, whose size varies.
std::size_t min_buffer_bytes(const PixelFormat& format, const DeviceFormat& device);

/// Returns the luma of a buffer of at least min_buffer_bytes(), for LumaWork::kNone.
LumaView luma_in_place(const PixelFormat& format, const DeviceFormat& device, const std::uint8_t* buffer);

}  // namespace stereod::v4l2
