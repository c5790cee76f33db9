// SPDX-License-Identifier: BSD-3-Clause
#include "calib/live/raw_image_pairing.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "daemon/lcm/limits.h"
#include "daemon/lcm/message_decoder.h"
#include "daemon/lcm/pixel_format_codes.h"

namespace stereod::calib {

namespace {

// Timestamps up to here can be subtracted and converted to nanoseconds without overflow.
constexpr std::int64_t kMaxUtime = std::numeric_limits<std::int64_t>::max() / 1000;

bool is_valid(const image_t& image) {
  const auto is_side = [](std::int32_t side) { return side > 0 && side <= kMaxImageSide; };
  if (image.pixelformat != kPixelFormatGray || !is_side(image.width) || !is_side(image.height)) return false;
  if (image.utime < 0 || image.utime > kMaxUtime || image.row_stride < image.width) return false;
  return image.data.size() >=
         static_cast<std::size_t>(image.height - 1) * static_cast<std::size_t>(image.row_stride) +
             static_cast<std::size_t>(image.width);
}

GrayImage pixels_of(const image_t& image) {
  GrayImage result(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    const auto* row = image.data.data() + static_cast<std::ptrdiff_t>(y) * image.row_stride;
    std::copy_n(row, image.width, result.row(y));
  }
  return result;
}

}  // namespace

void RawImagePairing::FrameTime::add(std::int64_t utime) {
  constexpr std::size_t kIntervals = 8;
  if (const auto last = std::exchange(last_utime_, utime); last && utime > *last) {
    intervals_us_.push_back(utime - *last);
    if (intervals_us_.size() > kIntervals) intervals_us_.pop_front();
  }
}

std::int64_t RawImagePairing::FrameTime::frame_ns() const {
  if (intervals_us_.empty()) return 0;
  return 1000 * *std::min_element(intervals_us_.begin(), intervals_us_.end());
}

bool RawImagePairing::add(Side side, std::span<const std::byte> message) {
  image_t image;
  if (!decode_message(message, image) || !is_valid(image)) return false;
  (side == Side::kLeft ? left_ : right_).add(image.utime);
  const std::int64_t slower_ns = std::max(left_.frame_ns(), right_.frame_ns());
  if (slower_ns > 0) pairing_.set_tolerance_ns(slower_ns / 2);
  pairing_.add(side, pixels_of(image), 1000 * image.utime);
  return true;
}

std::optional<ImagePair> RawImagePairing::take() {
  auto pair = pairing_.take();
  if (!pair || pair->left.size() != pair->right.size()) return std::nullopt;
  return ImagePair{"", std::move(pair->left), std::move(pair->right)};
}

}  // namespace stereod::calib
