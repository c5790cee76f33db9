// The message bus that is LCM.
#pragma once

#include <mutex>

#include "daemon/lcm/handle.h"
#include "daemon/lcm/message_bus.h"

namespace stereod {

/// A URL that one can publish to, checked without opening anything. Throws a permanent BusError.
LcmUrl url_to_publish(const std::string& url);

/// Publishes on LCM. It never subscribes, so LCM starts no thread and opens no port that receives.
class LcmBus : public MessageBus {
 public:
  /// `url` as in effective_lcm_url(); a file must be opened with mode=w or mode=a. Throws BusError.
  explicit LcmBus(const std::string& url);

  /// Allocates nothing with udpm after the first message, for which GLib makes a mutex (measured, LCM 1.3.1,
  /// messages of 1 B to 2 MB); a log file takes one allocation a message. What does not fit in one datagram
  /// (channel and data > 65,499 B) is sent in fragments.
  bool publish(const char* channel, const void* data, std::size_t size) noexcept override;

 private:
  LcmHandle lcm_;
  bool is_udp_ = false;
  std::mutex file_mutex_;
};

}  // namespace stereod
