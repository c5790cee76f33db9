// The rectified left image, on request.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/base/image.h"
#include "daemon/config/config.h"
#include "daemon/imagefile/jpeg_encoder.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "stereod/image_t.hpp"

namespace stereod {

/// Publishes PREFIX_LEFT, so many images a second at most, from a thread of its own. The workers fill a
/// image when one is due and the last one is sent; else they do nothing. A JPEG of 640×480 pixels is one
/// datagram; a gray image is several, of which one lost loses all (see RawPublisher).
class LeftPublisher {
 public:
  LeftPublisher(MessageBus& bus, const std::string& prefix, const LeftImageConfig& config, Size size);
  ~LeftPublisher();
  LeftPublisher(const LeftPublisher&) = delete;
  LeftPublisher& operator=(const LeftPublisher&) = delete;

  /// The image to fill with the rectified rows of this frame; null if none is due. Allocates nothing, waits
  /// for nothing.
  GrayImage* take_if_due() noexcept;
  /// The image taken is filled; `utime` is its frame's.
  void send(std::int64_t utime) noexcept;
  void stop() noexcept;

  std::int64_t refused() const noexcept { return refused_; }

 private:
  void run() noexcept;
  void publish_picture() noexcept;

  MessageBus& bus_;
  const std::string channel_;
  const std::int64_t period_ns_;
  std::int64_t next_ns_ = 0;  // of the thread that takes

  std::mutex mutex_;
  std::condition_variable changed_;
  bool full_ = false;
  bool stopping_ = false;
  GrayImage picture_;
  std::optional<JpegEncoder> jpeg_;
  image_t message_{};
  MessageEncoder encoder_;
  std::atomic<std::int64_t> refused_{0};
  std::thread thread_;
};

}  // namespace stereod
