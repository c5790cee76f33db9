// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/depth_publisher.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/geometry/depth.h"
#include "daemon/lcm/limits.h"

namespace stereod {
namespace {

std::uint16_t in_mm(double meters) {
  constexpr double kMax = DepthPublisher::kFarthest;
  // 0 means "not known", so a measured depth is at least 1.
  return static_cast<std::uint16_t>(std::clamp(std::round(meters * 1000), 1.0, kMax));
}

}  // namespace

std::vector<double> depths_of_disparities(const Calibration& calibration, const MatcherOptions& matcher) {
  const int units = matcher.units_per_pixel();
  std::vector<double> depths;
  for (int value = 0; value <= (matcher.min_disparity + matcher.disparities) * units; ++value) {
    depths.push_back(depth_m(calibration, static_cast<double>(value) / units));
  }
  return depths;
}

DepthPublisher::DepthPublisher(MessageBus& bus, const std::string& prefix, const Calibration& calibration,
                               const MatcherOptions& matcher, const PublishedPixels& pixels, int max_rows)
    : bus_(bus), channel_(prefix + "_DEPTH"), encoder_(kMaxDatagram) {
  for (const double meters : depths_of_disparities(calibration, matcher)) depth_mm_.push_back(in_mm(meters));
  message_.width = pixels.width;
  message_.height = pixels.height;
  message_.left = pixels.left;
  message_.top = pixels.top;
  message_.decimation_x = pixels.decimation_x;
  message_.decimation_y = pixels.decimation_y;
  message_.data.reserve(bytes_for_rows(max_rows));
}

std::size_t DepthPublisher::bytes_for_rows(int rows) const noexcept {
  return static_cast<std::size_t>(rows * message_.width * kBytesPerValue);
}

void DepthPublisher::take_rows(const FinalRows& rows) noexcept {
  message_.utime = rows.timing.utime;
  message_.frame = rows.timing.frame;
  message_.first_row = rows.published.first;
  message_.row_count = rows.published.count();
  message_.data.resize(bytes_for_rows(message_.row_count));
  message_.size = static_cast<std::int32_t>(message_.data.size());
  const std::size_t last = depth_mm_.size() - 1;
  std::uint8_t* out = message_.data.data();
  for (int v = rows.published.first; v < rows.published.end; ++v) {
    const std::int16_t* in = rows.disparity.row(message_.top + v * message_.decimation_y) + message_.left;
    for (int u = 0; u < message_.width; ++u, out += kBytesPerValue) {
      const std::int16_t value = in[std::ptrdiff_t{u} * message_.decimation_x];
      const unsigned mm = value < 0 ? 0U : depth_mm_[std::min(static_cast<std::size_t>(value), last)];
      out[0] = static_cast<std::uint8_t>(mm);
      out[1] = static_cast<std::uint8_t>(mm >> 8);
    }
  }
  if (!encoder_.publish(bus_, channel_.c_str(), message_)) ++refused_;
}

}  // namespace stereod
