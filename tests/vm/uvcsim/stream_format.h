// SPDX-License-Identifier: BSD-3-Clause
// The formats of the simulated camera and their negotiation (USB Video Class 1.0, 4.3.1.1).
#pragma once

#include <array>
#include <cstdint>

#include "core/base/image.h"
#include "tests/vm/uvcsim/bytes.h"

namespace stereod::uvcsim {

/// Values are the numbers of the format descriptors.
enum class Encoding : std::uint8_t { kYuyv = 1, kMjpeg = 2 };

constexpr std::array<Size, 2> kSizes{Size{640, 480}, Size{320, 240}};
/// Frame times in units of 100 ns: 30, 20, 15 and 10 frames a second.
constexpr std::array<std::uint32_t, 4> kFrameTimes{333'333, 500'000, 666'666, 1'000'000};

constexpr std::uint32_t max_image_bytes(Size size) {
  return static_cast<std::uint32_t>(size.width * size.height * 2);
}

/// Size of one payload, which is one transfer of the kernel.
constexpr std::uint32_t kPayloadBytes = 16384;
constexpr std::size_t kNegotiationBytes = 26;

struct StreamFormat {
  Encoding encoding = Encoding::kMjpeg;
  Size size = kSizes[0];
  std::uint32_t frame_time = kFrameTimes[0];  ///< 100 ns
};

/// Returns the format nearest to the host's request.
StreamFormat negotiated(ByteSpan wish);
Bytes negotiation_bytes(const StreamFormat& format);

}  // namespace stereod::uvcsim
