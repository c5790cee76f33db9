// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/message_decoder.h"

#include <cstdint>

namespace stereod {

bool has_pointcloud_layout(std::span<const std::byte> bytes) noexcept {
  constexpr std::size_t kBeforeName = 8 + 8 + 8;  // fingerprint, utime, seq
  constexpr std::size_t kLength = 4;
  constexpr std::size_t kBytesPerPoint = 12;
  constexpr std::size_t kMaxBytes = 1 << 30;
  const auto number_at = [&](std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < kLength; ++i)
      number = number << 8 | std::to_integer<std::uint32_t>(bytes[at + i]);
    return std::size_t{number};
  };
  std::size_t rest = bytes.size();
  if (rest > kMaxBytes || rest < kBeforeName + kLength) return false;
  rest -= kBeforeName + kLength;
  const std::size_t name = number_at(kBeforeName);  // with its closing zero
  if (name < 1 || name > rest || rest - name < 2 * kLength) return false;
  if (bytes[kBeforeName + kLength + name - 1] != std::byte{0}) return false;
  rest -= name + 2 * kLength;
  const std::size_t points = number_at(kBeforeName + kLength + name);
  return rest % kBytesPerPoint == 0 && points == rest / kBytesPerPoint &&
         number_at(bytes.size() - kLength) == 0;
}

}  // namespace stereod
