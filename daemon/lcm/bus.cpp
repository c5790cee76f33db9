// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/bus.h"

#include <cerrno>
#include <cstring>

#include "daemon/lcm/limits.h"

namespace stereod {

LcmUrl url_to_publish(const std::string& text) {
  LcmUrl url = checked_lcm_url(text);
  const std::string mode = url.option("mode").value_or("r");
  if (url.provider == "file" && mode != "w" && mode != "a") {
    throw BusError("LCM URL '" + url.text() + "': publishing to a file needs ?mode=w (or mode=a to append)",
                   true);
  }
  return url;
}

LcmBus::LcmBus(const std::string& url) {
  const LcmUrl checked = url_to_publish(url);
  lcm_ = open_lcm(checked);
  is_udp_ = checked.provider == "udpm";
}

bool LcmBus::publish(const char* channel, const void* data, std::size_t size) noexcept {
  const std::size_t channel_length = std::strlen(channel);
  // LCM would print a line for each.
  if (channel_length > LCM_MAX_CHANNEL_NAME_LENGTH || size > LCM_MAX_MESSAGE_SIZE) return false;
  // LCM writes an event of a log in several pieces without a lock; for the network it has one.
  std::unique_lock<std::mutex> whole_event(file_mutex_, std::defer_lock);
  if (!is_udp_) whole_event.lock();
  errno = 0;
  if (lcm_publish(lcm_.get(), channel, data, static_cast<unsigned int>(size)) != 0) return false;
  // LCM 1.3.1 reports success for a fragmented message even if fragments were refused; errno shows it.
  const bool fragmented = is_udp_ && channel_length + 1 + size > kMaxDatagram;
  return !fragmented || errno == 0;
}

}  // namespace stereod
