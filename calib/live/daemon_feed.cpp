#include "calib/live/daemon_feed.h"

#include <algorithm>
#include <stereod/image_t.hpp>

#include "core/base/limits.h"
#include "daemon/lcm/pixel_format_codes.h"

namespace stereod {

namespace {

constexpr std::int64_t kTolerance_ns = 50'000'000;  // both are of one pair, which the daemon has made

// Whether the image's numbers fit its data.
bool is_sound(const image_t& image) {
  return image.pixelformat == kPixelFormatGray && image.width > 0 && image.width <= kMaxImageSide &&
         image.height > 0 && image.height <= kMaxImageSide && image.row_stride >= image.width &&
         image.data.size() >=
             static_cast<std::size_t>(image.height - 1) * static_cast<std::size_t>(image.row_stride) +
                 static_cast<std::size_t>(image.width);
}

}  // namespace

DaemonFeed::DaemonFeed(const std::string& lcm_url, const std::string& prefix)
    : receiver_(lcm_url), pairing_(kTolerance_ns) {
  receiver_.subscribe(prefix + "_LEFT_RAW", [this](auto message) { take(Side::kLeft, message); });
  receiver_.subscribe(prefix + "_RIGHT_RAW", [this](auto message) { take(Side::kRight, message); });
}

void DaemonFeed::take(Side side, std::span<const std::byte> message) {
  image_t image;
  const bool decoded = image.decode(message.data(), 0, static_cast<int>(message.size())) >= 0;
  if (!decoded || !is_sound(image)) return;
  GrayImage picture(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    std::copy_n(image.data.data() + static_cast<std::ptrdiff_t>(y) * image.row_stride, image.width,
                picture.row(y));
  }
  pairing_.add(side, std::move(picture), 1000 * image.utime);
}

std::optional<ImagePair> DaemonFeed::next(std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    const bool more = receiver_.receive(std::max(left, std::chrono::milliseconds(1)));
    if (auto pair = pairing_.take(); pair && pair->left.size() == pair->right.size()) {
      ++taken_;
      return ImagePair{"pair " + std::to_string(taken_), std::move(pair->left), std::move(pair->right)};
    }
    if (!more && std::chrono::steady_clock::now() >= end) return std::nullopt;
  }
}

}  // namespace stereod
