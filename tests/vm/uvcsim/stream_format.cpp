// SPDX-License-Identifier: BSD-3-Clause
// Negotiation.
#include "tests/vm/uvcsim/stream_format.h"

#include <algorithm>
#include <cstdlib>

namespace stereod::uvcsim {

StreamFormat negotiated(ByteSpan wish) {
  StreamFormat format;
  format.encoding = get_little(wish, 2, 1) == static_cast<std::uint32_t>(Encoding::kYuyv) ? Encoding::kYuyv
                                                                                          : Encoding::kMjpeg;
  const std::uint32_t size = get_little(wish, 3, 1);  // counted from 1
  format.size = kSizes[size >= 1 && size <= kSizes.size() ? size - 1 : 0];
  const auto wanted = std::int64_t{get_little(wish, 4, 4)};
  format.frame_time = *std::min_element(
      kFrameTimes.begin(), kFrameTimes.end(),
      [wanted](std::int64_t a, std::int64_t b) { return std::llabs(a - wanted) < std::llabs(b - wanted); });
  return format;
}

Bytes negotiation_bytes(const StreamFormat& format) {
  Bytes bytes;
  put_little(bytes, 0, 2);  // no hints
  put_little(bytes, static_cast<std::uint32_t>(format.encoding), 1);
  const auto size = std::find(kSizes.begin(), kSizes.end(), format.size);
  put_little(bytes, static_cast<std::uint32_t>(size - kSizes.begin() + 1), 1);
  put_little(bytes, format.frame_time, 4);
  for (int i = 0; i < 5; ++i) put_little(bytes, 0, 2);  // key frames, compression, window, delay
  put_little(bytes, max_image_bytes(format.size), 4);
  put_little(bytes, kPayloadBytes, 4);
  return bytes;
}

}  // namespace stereod::uvcsim
