// SPDX-License-Identifier: BSD-3-Clause
// The interface between publishers and the network.
#pragma once

#include <cstddef>

namespace stereod {

/// Sends encoded messages. publish() may be called by several threads at once.
class MessageBus {
 public:
  virtual ~MessageBus() = default;

  /// Sends a message of @p size bytes on @p channel (1…63 characters). Returns false if the network refused
  /// it. Does not wait for receivers.
  virtual bool publish(const char* channel, const void* data, std::size_t size) noexcept = 0;
};

}  // namespace stereod
