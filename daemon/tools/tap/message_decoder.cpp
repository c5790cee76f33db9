#include "daemon/tools/tap/message_decoder.h"

#include <cstdint>
#include <optional>

namespace stereod {
namespace {

constexpr std::size_t kFingerprintBytes = 8;
constexpr std::size_t kMaxMessage = 1U << 28;  // LCM's own limit

/// Takes `count` bytes off the front; false if there are fewer.
bool skip(std::span<const std::byte>& bytes, std::size_t count) {
  if (count > bytes.size()) return false;
  bytes = bytes.subspan(count);
  return true;
}

/// Takes a big-endian length off the front; nothing if it is not there or negative.
std::optional<std::size_t> take_length(std::span<const std::byte>& bytes) {
  if (bytes.size() < 4) return std::nullopt;
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) length = length << 8 | std::to_integer<std::uint32_t>(bytes[i]);
  bytes = bytes.subspan(4);
  if (length > kMaxMessage) return std::nullopt;
  return length;
}

bool skip_string(std::span<const std::byte>& bytes) {
  const std::optional<std::size_t> length = take_length(bytes);
  if (!length || *length == 0 || *length > bytes.size() || bytes[*length - 1] != std::byte{0}) return false;
  return skip(bytes, *length);
}

bool skip_array(std::span<const std::byte>& bytes) {
  const std::optional<std::size_t> length = take_length(bytes);
  return length && skip(bytes, *length);
}

bool skip_field(std::span<const std::byte>& bytes, char kind) {
  switch (kind) {
    case 'b':
      return skip(bytes, 1);
    case 'i':
      return skip(bytes, 4);
    case 'd':
      return skip(bytes, 8);
    case 's':
      return skip_string(bytes);
    case 'v':
      return skip_array(bytes);
    default:
      return false;
  }
}

}  // namespace

bool has_layout(std::span<const std::byte> bytes, std::string_view layout) noexcept {
  if (bytes.size() > kMaxMessage || !skip(bytes, kFingerprintBytes)) return false;
  for (const char kind : layout) {
    if (!skip_field(bytes, kind)) return false;
  }
  return bytes.empty();
}

}  // namespace stereod
