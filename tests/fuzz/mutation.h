// SPDX-License-Identifier: BSD-3-Clause
// Inputs changed here and there, always the same ones: what drives a fuzz target without a fuzzer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/support/random_images.h"

namespace stereod {

using Bytes = std::vector<std::uint8_t>;

/// Changes, cuts or lengthens `bytes` in up to twelve places, every fourth of them in the first `head` bytes.
inline void mutate(Bytes& bytes, Random& random, std::size_t head) {
  const int changes = random.between(1, 12);
  for (int i = 0; i < changes && !bytes.empty(); ++i) {
    const auto at = static_cast<std::size_t>(random.between(0, static_cast<int>(bytes.size()) - 1));
    switch (random.between(0, 4)) {
      case 0:
        bytes[at] = static_cast<std::uint8_t>(random.between(0, 255));
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1 << random.between(0, 7)));
        break;
      case 2:
        bytes.resize(at);
        break;
      case 3:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     static_cast<std::size_t>(random.between(1, 9)), 0xff);
        break;
      default:
        bytes[random.between(0, 3) == 0 ? at : at % head] = static_cast<std::uint8_t>(random.between(0, 255));
    }
  }
}

}  // namespace stereod
