// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/left_publisher.h"

#include "daemon/lcm/pixel_format_codes.h"

namespace stereod {
namespace {

constexpr int kJpegQuality = 80;           // 640×480 pixels take 30 to 60 KB
constexpr std::size_t kHeader = 128;       // the other fields of the message [bytes]
constexpr std::size_t kJpegHeader = 2048;  // how much longer than its pixels a JPEG may be [bytes]

// A JPEG of noise may be larger than its pixels.
std::size_t max_data_bytes(Size size) {
  return 2 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) + kJpegHeader;
}

}  // namespace

LeftPublisher::LeftPublisher(MessageBus& bus, const std::string& prefix, const LeftImageConfig& config,
                             Size size)
    : bus_(bus),
      channel_(prefix + "_LEFT"),
      image_(size),
      encoder_(max_data_bytes(size) + kHeader),
      publisher_(config.per_second, [this] { return send() ? 0 : 1; }) {
  if (config.jpeg) jpeg_.emplace(size, kJpegQuality);
  message_.width = size.width;
  message_.height = size.height;
  message_.row_stride = config.jpeg ? 0 : size.width;
  message_.pixelformat = config.jpeg ? kPixelFormatMjpeg : kPixelFormatGray;
  message_.data.reserve(max_data_bytes(size));
}

void LeftPublisher::submit(std::int64_t utime) noexcept {
  message_.utime = utime;
  publisher_.submit();
}

bool LeftPublisher::send() noexcept {
  if (jpeg_) {
    const std::span<const std::uint8_t> bytes = jpeg_->encode(image_.view());
    message_.data.assign(bytes.begin(), bytes.end());
  } else {
    message_.data.clear();
    for (int y = 0; y < image_.height(); ++y) {
      message_.data.insert(message_.data.end(), image_.row(y), image_.row(y) + image_.width());
    }
  }
  message_.size = static_cast<std::int32_t>(message_.data.size());
  return message_.size > 0 && encoder_.publish(bus_, channel_.c_str(), message_);
}

}  // namespace stereod
