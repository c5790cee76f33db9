#include "daemon/publish/left_publisher.h"

#include <algorithm>

#include "daemon/base/clocks.h"
#include "daemon/lcm/pixel_format_codes.h"

namespace stereod {
namespace {

constexpr int kQuality = 80;               // 640×480 pixels take 30 to 60 KB
constexpr std::size_t kHeader = 128;       // the message's other fields
constexpr std::size_t kJpegHeader = 2048;  // a JPEG may be so much longer than its image

}  // namespace

LeftPublisher::LeftPublisher(MessageBus& bus, const std::string& prefix, const LeftImageConfig& config,
                             Size size)
    : bus_(bus),
      channel_(prefix + "_LEFT"),
      period_ns_(static_cast<std::int64_t>(1e9 / config.per_second)),
      picture_(size),
      encoder_(2 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) + kHeader +
               kJpegHeader) {
  if (config.jpeg) jpeg_.emplace(size, kQuality);
  message_.width = size.width;
  message_.height = size.height;
  message_.row_stride = config.jpeg ? 0 : size.width;
  message_.pixelformat = config.jpeg ? kPixelFormatMjpeg : kPixelFormatGray;
  message_.data.reserve(2 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) +
                        kJpegHeader);
  thread_ = std::thread([this] { run(); });
}

LeftPublisher::~LeftPublisher() { stop(); }

void LeftPublisher::stop() noexcept {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

GrayImage* LeftPublisher::take_if_due() noexcept {
  const std::int64_t now = monotonic_ns();
  if (now < next_ns_) return nullptr;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || full_) return nullptr;
  // A frame that comes a little early is in time, or every second one would be passed over.
  next_ns_ = std::max(next_ns_ + period_ns_, now - period_ns_ / 2);
  return &picture_;
}

void LeftPublisher::send(std::int64_t utime) noexcept {
  {
    const std::lock_guard lock(mutex_);
    message_.utime = utime;
    full_ = true;
  }
  changed_.notify_one();
}

void LeftPublisher::run() noexcept {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || full_; });
    if (stopping_) return;
    lock.unlock();  // nobody writes to the image while it is full
    publish_picture();
    lock.lock();
    full_ = false;
  }
}

void LeftPublisher::publish_picture() noexcept {
  if (jpeg_) {
    const std::span<const std::uint8_t> bytes = jpeg_->encode(picture_.view());
    message_.data.assign(bytes.begin(), bytes.end());
  } else {
    message_.data.clear();
    for (int y = 0; y < picture_.height(); ++y) {
      message_.data.insert(message_.data.end(), picture_.row(y), picture_.row(y) + picture_.width());
    }
  }
  message_.size = static_cast<std::int32_t>(message_.data.size());
  if (message_.size == 0 || !encoder_.publish(bus_, channel_.c_str(), message_)) ++refused_;
}

}  // namespace stereod
