// Where the brightness lies in each pixel format that is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "daemon/capture/frame_source.h"
#include "daemon/capture/v4l2/video_device.h"

namespace stereod {

/// What has to be done to a buffer before it is 8-bit luma.
enum class LumaWork {
  kNone,   ///< it lies in the buffer, to be read in place
  kScale,  ///< 16-bit words with 10 significant bits
  kJpeg,   ///< each buffer is a JPEG file
};

struct PixelFormat {
  std::uint32_t pixels = 0;
  std::string_view name;  ///< in the configuration
  LumaWork work = LumaWork::kNone;
  int bytes_per_pixel = 1;  ///< in the rows that hold the luma
  int luma_offset = 0;      ///< of the first pixel's luma in its row
  double traffic = 1;       ///< bytes a pixel on the bus; 0: compressed
};

/// The format with this fourcc, or with this name (gray, nv12, yu12, yuyv, uyvy, y10, y16, mjpeg); null if it
/// is not read here.
const PixelFormat* find_pixel_format(std::uint32_t pixels);
const PixelFormat* find_pixel_format(std::string_view name);
/// All of them, what puts the least on the bus first, compressed formats last.
std::span<const PixelFormat> pixel_formats();

/// Bytes from row to row. Some drivers say 0 and mean no padding.
std::size_t row_stride(const PixelFormat& format, const DeviceFormat& device);

/// The least number of bytes in a buffer that has the whole luma; 0 for JPEG, whose length varies.
std::size_t least_bytes(const PixelFormat& format, const DeviceFormat& device);

/// The luma of a buffer of `least_bytes`, for LumaWork::kNone.
LumaView luma_in_place(const PixelFormat& format, const DeviceFormat& device, const std::uint8_t* buffer);

}  // namespace stereod
