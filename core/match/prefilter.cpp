#include "core/match/prefilter.h"

#include <algorithm>

namespace stereod {

void xsobel_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                int cap, std::uint8_t* out) noexcept {
  const auto limit = static_cast<std::int16_t>(cap);
  for (int x = 1; x < width - 1; ++x) {
    const auto gradient = static_cast<std::int16_t>(
        (above[x + 1] - above[x - 1]) + 2 * (row[x + 1] - row[x - 1]) + (below[x + 1] - below[x - 1]));
    const auto clipped = std::clamp<std::int16_t>(gradient, static_cast<std::int16_t>(-limit), limit);
    out[x] = static_cast<std::uint8_t>(clipped + limit);
  }
  out[0] = static_cast<std::uint8_t>(cap);
  out[width - 1] = static_cast<std::uint8_t>(cap);
}

}  // namespace stereod
