// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client/wire_layout.h"

#include <algorithm>
#include <cstdint>

namespace stereod {
namespace {

constexpr std::size_t kFingerprintBytes = 8;
constexpr std::size_t kMaxMessage = 1U << 28;  // LCM's own limit

/// The bytes of a message that are not checked yet.
struct Remaining {
  const std::uint8_t* bytes;
  std::size_t size;

  bool skip(std::size_t count) {
    if (count > size) return false;
    bytes += count;
    size -= count;
    return true;
  }
  /// Reads and skips a big-endian length. Returns false if it is missing or above kMaxMessage.
  bool take_length(std::size_t& length) {
    if (size < 4) return false;
    length =
        std::size_t{bytes[0]} << 24 | std::size_t{bytes[1]} << 16 | std::size_t{bytes[2]} << 8 | bytes[3];
    return skip(4) && length <= kMaxMessage;
  }
  bool skip_string() {
    std::size_t length = 0;
    return take_length(length) && length > 0 && length <= size && bytes[length - 1] == 0 && skip(length);
  }
  bool skip_array(std::size_t bytes_each) {
    std::size_t length = 0;
    return take_length(length) && skip(length * bytes_each);
  }
  bool skip_field(char kind) {
    switch (kind) {
      case 'b':
        return skip(1);
      case 'i':
        return skip(4);
      case 'd':
        return skip(8);
      case 's':
        return skip_string();
      case 'v':
        return skip_array(1);
      case 'f':
        return skip_array(4);
      case 'z':
        return size >= 4 && std::all_of(bytes, bytes + 4, [](std::uint8_t b) { return b == 0; }) && skip(4);
      default:
        return false;
    }
  }
};

}  // namespace

bool has_layout(const void* bytes, std::size_t size, std::string_view layout) noexcept {
  Remaining remaining{static_cast<const std::uint8_t*>(bytes), size};
  if (size > kMaxMessage || !remaining.skip(kFingerprintBytes)) return false;
  for (const char kind : layout) {
    if (!remaining.skip_field(kind)) return false;
  }
  return remaining.size == 0;
}

}  // namespace stereod
