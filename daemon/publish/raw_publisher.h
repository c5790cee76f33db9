// What the cameras see, on request.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/capture/frame_source.h"
#include "daemon/capture/pair_queue.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "stereod/image_t.hpp"

namespace stereod {

/// Publishes both images of a pair on PREFIX_LEFT_RAW and PREFIX_RIGHT_RAW, so many pairs a second at most,
/// from a thread of its own: who offers pairs only ever copies, and only when one is due. A image is longer
/// than a datagram, so on a network that loses one fragment in a hundred a 640×480 image (200 fragments of
/// a wire's 1500 bytes) arrives one time in eight; on the machine itself, or with a large socket buffer, it
/// arrives. Calibration does not need every pair.
class RawPublisher {
 public:
  RawPublisher(MessageBus& bus, const std::string& prefix, double pairs_per_second, Size size);
  ~RawPublisher();
  RawPublisher(const RawPublisher&) = delete;
  RawPublisher& operator=(const RawPublisher&) = delete;

  /// Takes a copy of the pair if one is due and the last one is sent. `utime`: as in the messages of its
  /// frame, by which a log knows what belongs together. Allocates nothing, waits for nothing.
  void offer(const LeasedPair& pair, std::int64_t utime) noexcept;
  void stop() noexcept;

  std::int64_t refused() const noexcept { return refused_; }

 private:
  void run() noexcept;
  static void copy(const LumaView& luma, image_t& image) noexcept;

  MessageBus& bus_;
  const std::string left_channel_, right_channel_;
  const std::int64_t period_ns_;
  std::int64_t next_ns_ = 0;  // of offer()'s thread

  std::mutex mutex_;
  std::condition_variable changed_;
  bool full_ = false;
  bool stopping_ = false;
  image_t left_{}, right_{};
  MessageEncoder encoder_;
  std::atomic<std::int64_t> refused_{0};
  std::thread thread_;
};

}  // namespace stereod
