// SPDX-License-Identifier: BSD-3-Clause
// Sends images at a limited rate from a thread of its own.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include "daemon/base/clocks.h"

namespace stereod {

/// Hands one set of images at a time from the matching thread to a sending thread.
///
/// The owner keeps the image buffers. It fills them between claim() and submit(); the sending thread reads
/// them between submit() and the end of the send function. A frame that arrives while the previous images are
/// sent is skipped. Declare this member after the buffers: its destructor ends the thread.
class ImagePublisher {
 public:
  /// Sends the filled buffers. Returns how many messages the network refused. Must not throw.
  using Send = std::function<int()>;

  /// @p per_second is the maximum rate [Hz, > 0].
  ImagePublisher(double per_second, Send send);
  ~ImagePublisher();
  ImagePublisher(const ImagePublisher&) = delete;
  ImagePublisher& operator=(const ImagePublisher&) = delete;

  /// Returns true if images are due at @p now_ns [CLOCK_MONOTONIC] and the previous ones are sent. The caller
  /// then fills the buffers and calls submit(). Allocates nothing and does not wait. One thread.
  ///
  /// The rate is limited on average: a frame may come up to half a period early, or every second frame of a
  /// stream at exactly the maximum rate would be skipped.
  bool claim(std::int64_t now_ns = monotonic_ns()) noexcept;
  /// Passes the filled buffers to the sending thread.
  void submit() noexcept;
  /// Ends the thread; drops images that were not sent.
  void stop() noexcept;

  /// Returns how many messages the network refused since construction.
  std::int64_t refused() const noexcept { return refused_; }

 private:
  void run() noexcept;

  const std::int64_t period_ns_;
  const Send send_;
  std::int64_t next_ns_ = 0;  // used by the claiming thread only

  std::mutex mutex_;
  std::condition_variable changed_;
  bool full_ = false;
  bool stopping_ = false;
  std::atomic<std::int64_t> refused_{0};
  std::thread thread_;
};

}  // namespace stereod
