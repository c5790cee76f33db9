// What the simulated camera can stream, and the negotiation about it (USB Video Class 1.0, 4.3.1.1).
#pragma once

#include <array>
#include <cstdint>

#include "core/base/image.h"
#include "tests/vm/uvcsim/bytes.h"

namespace stereod::uvcsim {

/// The value is the number of the format's descriptor.
enum class Encoding : std::uint8_t { kYuyv = 1, kMjpeg = 2 };

constexpr std::array<Size, 2> kSizes{Size{640, 480}, Size{320, 240}};
/// Frame times in units of 100 ns: 30, 20, 15 and 10 frames a second.
constexpr std::array<std::uint32_t, 4> kFrameTimes{333'333, 500'000, 666'666, 1'000'000};

constexpr std::uint32_t bytes_at_most(Size size) {
  return static_cast<std::uint32_t>(size.width * size.height * 2);
}

/// One payload, and so one transfer of the kernel's.
constexpr std::uint32_t kPayloadBytes = 16384;
constexpr std::size_t kNegotiationBytes = 26;

struct StreamFormat {
  Encoding encoding = Encoding::kMjpeg;
  Size size = kSizes[0];
  std::uint32_t frame_time = kFrameTimes[0];  ///< 100 ns
};

/// What comes nearest to the host's wish.
StreamFormat negotiated(ByteSpan wish);
Bytes negotiation_bytes(const StreamFormat& format);

}  // namespace stereod::uvcsim
