#include "daemon/tools/view/live_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "daemon/imagefile/jpeg_encoder.h"
#include "daemon/lcm/limits.h"
#include "daemon/lcm/pixel_format_codes.h"

namespace stereod {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kQuiet{1};  // without frames for so long, the status alone is worth showing

// What belongs to a frame so much older or newer is not shown with it: it has ceased to come. Left images may
// be 10 s apart.
constexpr std::int64_t kScanUs = 2'000'000;
constexpr std::int64_t kLeftUs = 12'000'000;

bool is_near(std::int64_t utime, std::int64_t other, std::int64_t us) {
  std::int64_t apart = 0;
  if (__builtin_sub_overflow(utime, other, &apart)) return false;  // whatever the network sends
  return apart > -us && apart < us;
}

// As the daemon makes them; a page that draws anything else would be busy for long.
bool is_valid(const planar_lidar_t& scan) {
  constexpr std::size_t kMaxRays = 1024;
  constexpr float kFarthest = 1000;  // m
  return scan.ranges.size() <= kMaxRays && scan.intensities.size() == scan.ranges.size() &&
         std::isfinite(scan.rad0) && std::isfinite(scan.radstep) &&
         std::all_of(scan.ranges.begin(), scan.ranges.end(),
                     [](float r) { return r >= 0 && r <= kFarthest; });
}

std::vector<std::uint8_t> jpeg_of(const image_t& image) {
  const bool sane =
      image.width > 0 && image.width <= kMaxImageSide && image.height > 0 && image.height <= kMaxImageSide;
  if (!sane) return {};
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
  frame_came_ = Clock::now();
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
  status_came_ = Clock::now();
  if (status_came_ - frame_came_ > kQuiet) publish_locked(std::nullopt);
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
  if (shown && scan_ && is_near(scan_->utime, shown->utime, kScanUs)) snapshot->scan = scan_;
  snapshot->status = status_;
  snapshot->status_age_ms =
      std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - status_came_).count();
  if (shown && is_near(left_utime_, shown->utime, kLeftUs)) {
    snapshot->left_jpeg = left_jpeg_;
    snapshot->left_utime = left_utime_;
  }
  snapshot->counts = counts_;
  newest_ = std::move(snapshot);
  changed_.notify_all();
}

std::shared_ptr<const Snapshot> LiveView::wait_newer(std::int64_t after,
                                                     std::chrono::milliseconds patience) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return newest_ && newest_->number > after; });
  return newest_;
}

}  // namespace stereod
