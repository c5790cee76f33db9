// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/view/live_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "daemon/imagefile/jpeg_encoder.h"
#include "daemon/lcm/limits.h"
#include "daemon/lcm/pixel_format_codes.h"

namespace stereod::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kMaxFrameGap{1};  // after it a status alone makes a snapshot

// A scan or left image further in time from the frame is not shown with it: the daemon has stopped sending them. Left
// images may be 10 s apart.
constexpr std::int64_t kMaxScanDistance_us = 2'000'000;
constexpr std::int64_t kMaxLeftDistance_us = 12'000'000;

bool is_near(std::int64_t utime, std::int64_t other, std::int64_t limit_us) {
  std::int64_t difference = 0;
  if (__builtin_sub_overflow(utime, other, &difference)) return false;  // any value may arrive
  return difference > -limit_us && difference < limit_us;
}

// The limits of what the daemon sends; a larger scan would keep the page busy.
bool is_valid(const planar_lidar_t& scan) {
  constexpr std::size_t kMaxRays = 1024;
  constexpr float kMaxRange = 1000;  // m
  return scan.ranges.size() <= kMaxRays && scan.intensities.size() == scan.ranges.size() &&
         std::isfinite(scan.rad0) && std::isfinite(scan.radstep) &&
         std::all_of(scan.ranges.begin(), scan.ranges.end(),
                     [](float r) { return r >= 0 && r <= kMaxRange; });
}

std::vector<std::uint8_t> jpeg_of(const image_t& image) {
  const bool is_size_valid =
      image.width > 0 && image.width <= kMaxImageSide && image.height > 0 && image.height <= kMaxImageSide;
  if (!is_size_valid) return {};
  if (image.pixelformat == kPixelFormatMjpeg) return image.data;
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.pixelformat != kPixelFormatGray || image.row_stride != image.width || image.data.size() != pixels)
    return {};
  JpegEncoder encoder({image.width, image.height}, 80);
  const auto bytes = encoder.encode(GrayView(image.data.data(), image.width, image.height, image.row_stride));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

void LiveView::take(StereoFrame&& frame, const ReceptionCounts& counts) {
  const std::lock_guard lock(mutex_);
  counts_ = counts;
  frame_arrival_ = Clock::now();
  publish_locked(std::move(frame));
}

void LiveView::take(planar_lidar_t&& scan) {
  if (!is_valid(scan)) return;
  const std::lock_guard lock(mutex_);
  scan_ = std::move(scan);
}

void LiveView::take(status_t&& status) {
  const std::lock_guard lock(mutex_);
  status_ = std::move(status);
  status_arrival_ = Clock::now();
  if (status_arrival_ - frame_arrival_ > kMaxFrameGap) publish_locked(std::nullopt);
}

void LiveView::take(const image_t& left) {
  std::vector<std::uint8_t> jpeg = jpeg_of(left);
  if (jpeg.empty()) return;
  const std::lock_guard lock(mutex_);
  left_jpeg_ = std::move(jpeg);
  left_utime_ = left.utime;
}

void LiveView::publish_locked(std::optional<StereoFrame>&& frame) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->number = ++number_;
  snapshot->frame = std::move(frame);
  const auto& shown = snapshot->frame;
  if (shown && scan_ && is_near(scan_->utime, shown->utime, kMaxScanDistance_us)) snapshot->scan = scan_;
  snapshot->status = status_;
  snapshot->status_age_ms =
      std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - status_arrival_).count();
  if (shown && is_near(left_utime_, shown->utime, kMaxLeftDistance_us)) {
    snapshot->left_jpeg = left_jpeg_;
    snapshot->left_utime = left_utime_;
  }
  snapshot->counts = counts_;
  newest_ = std::move(snapshot);
  changed_.notify_all();
}

std::shared_ptr<const Snapshot> LiveView::wait_newer(std::int64_t after,
                                                     std::chrono::milliseconds max_wait) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, max_wait, [&] { return newest_ && newest_->number > after; });
  return newest_;
}

}  // namespace stereod::tools
