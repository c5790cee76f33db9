// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/cloud_publisher.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

#include "daemon/publish/depth_publisher.h"
#include "stereod/pointcloud_t.hpp"

namespace stereod {
namespace {

constexpr std::string_view kFrameId = "stereo_left";
constexpr std::size_t kBytesPerPoint = 3 * sizeof(float);
// Before the points: fingerprint, utime, seq, frame_id with its length and closing zero, n_points. After
// them: n_channels.
constexpr std::size_t kHead = 8 + 8 + 8 + 4 + kFrameId.size() + 1 + 4;
constexpr std::size_t kTail = 4;

// LCM is big-endian.
template <typename Number>
std::uint8_t* put(std::uint8_t* out, Number number) {
  for (int shift = 8 * (static_cast<int>(sizeof number) - 1); shift >= 0; shift -= 8) {
    *out++ = static_cast<std::uint8_t>(number >> shift);
  }
  return out;
}

std::uint8_t* put(std::uint8_t* out, float number) { return put(out, std::bit_cast<std::uint32_t>(number)); }

int decimated(int pixels, int decimation) { return (pixels + decimation - 1) / decimation; }

}  // namespace

CloudPublisher::CloudPublisher(MessageBus& bus, const std::string& prefix, const Calibration& calibration,
                               const MatcherOptions& matcher, const PublishedPixels& pixels, int decimation)
    : bus_(bus),
      channel_(prefix + "_CLOUD"),
      pixels_(pixels),
      decimation_(decimation),
      fy_(calibration.left.projection.fy),
      cy_(calibration.left.projection.cy) {
  for (const double meters : depths_of_disparities(calibration, matcher)) {
    depth_m_.push_back(std::isfinite(meters) ? static_cast<float>(meters) : 0.0F);
  }
  const RectifiedProjection& p = calibration.left.projection;
  for (int x = 0; x < pixels.columns().end; ++x) x_per_z_.push_back(static_cast<float>((x - p.cx) / p.fx));
  const auto max_points = static_cast<std::size_t>(decimated(pixels.columns().count(), decimation)) *
                          static_cast<std::size_t>(decimated(pixels.rows().count(), decimation));
  bytes_.resize(kHead + max_points * kBytesPerPoint + kTail);
  points_end_ = kHead;
}

void CloudPublisher::take_rows(const FinalRows& rows) noexcept {
  for (int y = rows.rectified.first; y < rows.rectified.end; ++y) {
    if ((y - pixels_.top) % decimation_ == 0) add_row(y, rows.disparity.row(y));
  }
}

void CloudPublisher::add_row(int y, const std::int16_t* disparity) noexcept {
  const auto y_per_z = static_cast<float>((y - cy_) / fy_);
  const std::size_t last = depth_m_.size() - 1;
  std::uint8_t* out = bytes_.data() + points_end_;
  for (int x = pixels_.left; x < pixels_.columns().end; x += decimation_) {
    if (disparity[x] < 0) continue;
    const float z = depth_m_[std::min(static_cast<std::size_t>(disparity[x]), last)];
    if (z == 0.0F) continue;
    out = put(put(put(out, x_per_z_[static_cast<std::size_t>(x)] * z), y_per_z * z), z);
    ++points_;
  }
  points_end_ = static_cast<std::size_t>(out - bytes_.data());
}

std::size_t CloudPublisher::bytes_at_end() const noexcept { return points_end_ + kTail; }

void CloudPublisher::end_frame(const FrameTiming& timing) noexcept {
  std::uint8_t* out = put(bytes_.data(), pointcloud_t::getHash());
  out = put(put(out, timing.utime), timing.frame);
  out = put(out, static_cast<std::int32_t>(kFrameId.size() + 1));
  out = std::copy(kFrameId.begin(), kFrameId.end(), out);
  *out++ = 0;
  put(out, points_);
  put(bytes_.data() + points_end_, std::int32_t{0});
  if (!bus_.publish(channel_.c_str(), bytes_.data(), bytes_at_end())) ++refused_;
  points_end_ = kHead;
  points_ = 0;
}

}  // namespace stereod
