// The seam between whoever has something to say and the network.
#pragma once

#include <cstddef>

namespace stereod {

/// Carries encoded messages to whoever listens. publish() may be called by several threads at once.
class MessageBus {
 public:
  virtual ~MessageBus() = default;

  /// Sends one message of `size` bytes on `channel` (1…63 characters); false if the network refused it.
  /// Allocates nothing and does not wait for receivers.
  virtual bool publish(const char* channel, const void* data, std::size_t size) noexcept = 0;
};

}  // namespace stereod
