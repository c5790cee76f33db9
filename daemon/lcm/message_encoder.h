// SPDX-License-Identifier: BSD-3-Clause
// Encodes messages without allocating.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "daemon/lcm/message_bus.h"

namespace stereod {

/// Encodes generated LCM messages into one buffer. Use one encoder per publishing thread.
class MessageEncoder {
 public:
  /// Allocates room for messages of up to @p capacity encoded bytes.
  explicit MessageEncoder(std::size_t capacity) : buffer_(capacity) {}

  /// Returns the encoded message, valid until the next call. Returns an empty span if it does not fit, or if
  /// a size field does not equal the size of its array (the generated code would read past the end of the
  /// array).
  template <typename Message>
  std::span<const std::byte> encode(const Message& message) noexcept {
    if (!sizes_match(message)) return {};
    const int size = message.getEncodedSize();
    if (size <= 0 || static_cast<std::size_t>(size) > buffer_.size()) return {};
    if (message.encode(buffer_.data(), 0, size) != size) return {};
    return {buffer_.data(), static_cast<std::size_t>(size)};
  }

  /// Encodes and sends a message. Returns false if it cannot be encoded or the network refused it.
  template <typename Message>
  bool publish(MessageBus& bus, const char* channel, const Message& message) noexcept {
    const std::span<const std::byte> bytes = encode(message);
    return !bytes.empty() && bus.publish(channel, bytes.data(), bytes.size());
  }

 private:
  template <typename Array>
  static bool size_matches(std::int32_t size, const Array& array) noexcept {
    return size >= 0 && static_cast<std::size_t>(size) == array.size();
  }

  // Checks the fields `size`, `filled_size` and `confidence_size` of messages that have them.
  template <typename Message>
  static bool sizes_match(const Message& message) noexcept {
    if constexpr (requires { message.size == 0 && message.data.empty(); }) {
      if (!size_matches(message.size, message.data)) return false;
    }
    if constexpr (requires { message.filled_size == 0 && message.filled.empty(); }) {
      if (!size_matches(message.filled_size, message.filled)) return false;
    }
    if constexpr (requires { message.confidence_size == 0 && message.confidence.empty(); }) {
      if (!size_matches(message.confidence_size, message.confidence)) return false;
    }
    return true;
  }

  std::vector<std::byte> buffer_;
};

}  // namespace stereod
