// SPDX-License-Identifier: BSD-3-Clause
// The table of pixel formats.
#include "daemon/capture/v4l2/pixel_format.h"

#include <algorithm>
#include <array>

namespace stereod::v4l2 {
namespace {

// Y16: of little-endian words with 16 significant bits, the high byte is the luma.
constexpr std::array<PixelFormat, 9> kFormats{{
    {make_fourcc('G', 'R', 'E', 'Y'), "gray", LumaWork::kNone, 1, 0, 1},
    {make_fourcc('N', 'V', '1', '2'), "nv12", LumaWork::kNone, 1, 0, 1.5},
    {make_fourcc('Y', 'U', '1', '2'), "yu12", LumaWork::kNone, 1, 0, 1.5},
    {make_fourcc('Y', 'U', 'Y', 'V'), "yuyv", LumaWork::kNone, 2, 0, 2},
    {make_fourcc('U', 'Y', 'V', 'Y'), "uyvy", LumaWork::kNone, 2, 1, 2},
    {make_fourcc('Y', '1', '0', ' '), "y10", LumaWork::kScale, 2, 0, 2},
    {make_fourcc('Y', '1', '6', ' '), "y16", LumaWork::kNone, 2, 1, 2},
    {make_fourcc('M', 'J', 'P', 'G'), "mjpeg", LumaWork::kJpeg, 0, 0, 0},
    {make_fourcc('J', 'P', 'E', 'G'), "mjpeg", LumaWork::kJpeg, 0, 0, 0},
}};

}  // namespace

const PixelFormat* find_pixel_format(std::uint32_t fourcc) {
  const auto* found = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const PixelFormat& format) { return format.fourcc == fourcc; });
  return found == kFormats.end() ? nullptr : found;
}

const PixelFormat* find_pixel_format(std::string_view name) {
  const auto* found = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const PixelFormat& format) { return format.name == name; });
  return found == kFormats.end() ? nullptr : found;
}

std::span<const PixelFormat> pixel_formats() { return kFormats; }

std::size_t row_stride(const PixelFormat& format, const DeviceFormat& device) {
  const auto minimum =
      static_cast<std::size_t>(device.size.width) * static_cast<std::size_t>(format.bytes_per_pixel);
  return std::max<std::size_t>(device.bytes_per_line, minimum);
}

std::size_t min_buffer_bytes(const PixelFormat& format, const DeviceFormat& device) {
  if (format.work == LumaWork::kJpeg) return 0;
  const auto width = static_cast<std::size_t>(device.size.width),
             height = static_cast<std::size_t>(device.size.height);
  if (height == 0) return 0;
  return row_stride(format, device) * (height - 1) + width * static_cast<std::size_t>(format.bytes_per_pixel);
}

LumaView luma_in_place(const PixelFormat& format, const DeviceFormat& device, const std::uint8_t* buffer) {
  return {buffer + format.luma_offset, device.size, static_cast<std::ptrdiff_t>(row_stride(format, device)),
          format.bytes_per_pixel};
}

}  // namespace stereod::v4l2
