// SPDX-License-Identifier: BSD-3-Clause
// Publishes on LCM.
#pragma once

#include <mutex>

#include "daemon/lcm/handle.h"
#include "daemon/lcm/message_bus.h"

namespace stereod {

/// Parses a URL to publish to and checks it without opening it.
/// @throws BusError (permanent) if the URL is invalid or names a file that is not opened for writing.
LcmUrl url_to_publish(const std::string& url);

/// Publishes on LCM. Never subscribes, so LCM starts no thread and opens no receiving port.
class LcmBus : public MessageBus {
 public:
  /// @p url as in effective_lcm_url(); a file needs mode=w or mode=a.
  /// @throws BusError
  explicit LcmBus(const std::string& url);

  /// With udpm, allocates nothing after the first message, for which GLib creates a mutex (measured with LCM
  /// 1.3.1, messages of 1 B to 2 MB). A log file takes one allocation per message. A message larger than a
  /// datagram (channel and data > kMaxDatagram) is sent in fragments.
  bool publish(const char* channel, const void* data, std::size_t size) noexcept override;

 private:
  LcmHandle lcm_;
  bool is_udp_ = false;
  std::mutex file_mutex_;
};

}  // namespace stereod
