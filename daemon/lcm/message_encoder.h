// From a message in memory to bytes on the wire, without allocating.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/lcm/message_bus.h"

namespace stereod {

/// Encodes generated LCM messages into one buffer, allocated once. One per thread that publishes.
class MessageEncoder {
 public:
  /// Room for messages of up to `capacity` encoded bytes. Throws std::bad_alloc.
  explicit MessageEncoder(std::size_t capacity) : buffer_(capacity) {}

  /// The encoded message, valid until the next call. Empty if it does not fit the buffer, or if its `size` is
  /// not the length of its `data`, `filled_size` that of `filled` or `confidence_size` that of `confidence` (the generated code would read past the
  /// end).
  template <typename Message>
  std::span<const std::byte> encode(const Message& message) noexcept {
    if constexpr (requires { message.data.size() == static_cast<std::size_t>(message.size); }) {
      if (message.size < 0 || static_cast<std::size_t>(message.size) != message.data.size()) return {};
    }
    if constexpr (requires { message.filled.size() == static_cast<std::size_t>(message.filled_size); }) {
      if (message.filled_size < 0 || static_cast<std::size_t>(message.filled_size) != message.filled.size())
        return {};
    }
    if constexpr (requires {
                    message.confidence.size() == static_cast<std::size_t>(message.confidence_size);
                  }) {
      if (message.confidence_size < 0 ||
          static_cast<std::size_t>(message.confidence_size) != message.confidence.size())
        return {};
    }
    const int size = message.getEncodedSize();
    if (size <= 0 || static_cast<std::size_t>(size) > buffer_.size()) return {};
    if (message.encode(buffer_.data(), 0, size) != size) return {};
    return {buffer_.data(), static_cast<std::size_t>(size)};
  }

  /// Encodes and sends; false if the message cannot be encoded or the network refused it.
  template <typename Message>
  bool publish(MessageBus& bus, const char* channel, const Message& message) noexcept {
    const std::span<const std::byte> bytes = encode(message);
    return !bytes.empty() && bus.publish(channel, bytes.data(), bytes.size());
  }

 private:
  std::vector<std::byte> buffer_;
};

}  // namespace stereod
