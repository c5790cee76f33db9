#include "daemon/publish/raw_publisher.h"

#include <cstring>

#include "daemon/base/clocks.h"
#include "daemon/lcm/pixel_format_codes.h"

namespace stereod {
namespace {

constexpr std::size_t kHeader = 128;  // the message's other fields

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

}  // namespace

RawPublisher::RawPublisher(MessageBus& bus, const std::string& prefix, double pairs_per_second, Size size)
    : bus_(bus),
      left_channel_(prefix + "_LEFT_RAW"),
      right_channel_(prefix + "_RIGHT_RAW"),
      period_ns_(static_cast<std::int64_t>(1e9 / pairs_per_second)),
      left_(empty_image(size)),
      right_(empty_image(size)),
      encoder_(left_.data.size() + kHeader),
      thread_([this] { run(); }) {}

RawPublisher::~RawPublisher() { stop(); }

void RawPublisher::stop() noexcept {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void RawPublisher::offer(const LeasedPair& pair, std::int64_t utime) noexcept {
  const std::int64_t now = monotonic_ns();
  if (now < next_ns_) return;
  {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || full_) return;
    copy(pair.left.frame().luma, left_);
    copy(pair.right.frame().luma, right_);
    left_.utime = utime;
    right_.utime = left_.utime + pair.skew_ns() / 1000;
    full_ = true;
  }
  next_ns_ = now + period_ns_;
  changed_.notify_one();
}

void RawPublisher::copy(const LumaView& luma, image_t& image) noexcept {
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

void RawPublisher::run() noexcept {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || full_; });
    if (stopping_) return;
    // Nobody writes to the images while they are full.
    lock.unlock();
    if (!encoder_.publish(bus_, left_channel_.c_str(), left_)) ++refused_;
    if (!encoder_.publish(bus_, right_channel_.c_str(), right_)) ++refused_;
    lock.lock();
    full_ = false;
  }
}

}  // namespace stereod
