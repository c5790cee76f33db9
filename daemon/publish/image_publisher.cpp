// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/image_publisher.h"

#include <algorithm>
#include <utility>

namespace stereod {

ImagePublisher::ImagePublisher(double per_second, Send send)
    : period_ns_(static_cast<std::int64_t>(1e9 / per_second)),
      send_(std::move(send)),
      thread_([this] { run(); }) {}

ImagePublisher::~ImagePublisher() { stop(); }

void ImagePublisher::stop() noexcept {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool ImagePublisher::claim(std::int64_t now_ns) noexcept {
  if (now_ns < next_ns_) return false;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || full_) return false;
  next_ns_ = std::max(next_ns_ + period_ns_, now_ns - period_ns_ / 2);
  return true;
}

void ImagePublisher::submit() noexcept {
  {
    const std::lock_guard lock(mutex_);
    full_ = true;
  }
  changed_.notify_one();
}

void ImagePublisher::run() noexcept {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || full_; });
    if (stopping_) return;
    lock.unlock();  // the buffers are not written while full_ is set
    refused_ += send_();
    lock.lock();
    full_ = false;
  }
}

}  // namespace stereod
