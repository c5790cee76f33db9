// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/raw_publisher.h"

#include <cstring>

#include "daemon/lcm/pixel_format_codes.h"

namespace stereod {
namespace {

constexpr std::size_t kHeader = 128;  // the other fields of the message [bytes]

image_t empty_image(Size size) {
  image_t image{};
  image.width = size.width;
  image.height = size.height;
  image.row_stride = size.width;
  image.pixelformat = kPixelFormatGray;
  image.size = size.width * size.height;
  image.data.resize(static_cast<std::size_t>(image.size));
  return image;
}

void copy(const RawImage& raw, image_t& image) noexcept {
  const LumaView& luma = raw.luma;
  image.utime = raw.utime;
  std::uint8_t* out = image.data.data();
  for (int y = 0; y < image.height; ++y, out += image.width) {
    const std::uint8_t* row = luma.data + y * luma.row_stride;
    if (luma.pixel_stride == 1) {
      std::memcpy(out, row, static_cast<std::size_t>(image.width));
    } else {
      for (std::ptrdiff_t x = 0; x < image.width; ++x) out[x] = row[x * luma.pixel_stride];
    }
  }
}

}  // namespace

RawPublisher::RawPublisher(MessageBus& bus, const std::string& prefix, double pairs_per_second, Size size)
    : bus_(bus),
      left_channel_(prefix + "_LEFT_RAW"),
      right_channel_(prefix + "_RIGHT_RAW"),
      left_(empty_image(size)),
      right_(empty_image(size)),
      encoder_(left_.data.size() + kHeader),
      publisher_(pairs_per_second, [this] {
        const bool left_sent = encoder_.publish(bus_, left_channel_.c_str(), left_);
        const bool right_sent = encoder_.publish(bus_, right_channel_.c_str(), right_);
        return (left_sent ? 0 : 1) + (right_sent ? 0 : 1);
      }) {}

void RawPublisher::offer(const RawImage& left, const RawImage& right) noexcept {
  if (!publisher_.claim()) return;
  copy(left, left_);
  copy(right, right_);
  publisher_.submit();
}

}  // namespace stereod
