#include "core/match/median.h"

#include <algorithm>
#include <array>

#include "core/disparity.h"

namespace stereod {

void median_row(const std::int16_t* const* rows, int row_count, const std::int16_t* center, int width, int radius,
                std::int16_t* out) noexcept {
  std::array<std::int16_t, 25> values;
  for (int x = 0; x < width; ++x) {
    if (center[x] == kInvalidDisparity) {
      out[x] = kInvalidDisparity;
      continue;
    }
    auto end = values.begin();
    for (int row = 0; row < row_count; ++row) {
      for (int i = std::max(0, x - radius); i <= std::min(width - 1, x + radius); ++i) {
        if (rows[row][i] != kInvalidDisparity) *end++ = rows[row][i];
      }
    }
    const auto middle = values.begin() + (end - values.begin() - 1) / 2;
    std::nth_element(values.begin(), middle, end);
    out[x] = *middle;
  }
}

}  // namespace stereod
