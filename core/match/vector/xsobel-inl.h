// SPDX-License-Identifier: BSD-3-Clause
// The prefilter of both matchers, compiled with each vector layer.
#pragma once

#include <cstdint>

namespace stereod::kernels {

/// xsobel_row() of core/match/block/prefilter.h.
template <typename V>
class Xsobel {
 public:
  static void row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                  int cap, std::uint8_t* out) {
    const int last = width - 1;
    int x = 1;
    if (last - 1 >= V::kBytes) {
      for (; x + V::kBytes <= last; x += V::kBytes) V::xsobel(above + x, row + x, below + x, cap, out + x);
      x = last - V::kBytes;  // the rest: a whole vector that overlaps the one before
      V::xsobel(above + x, row + x, below + x, cap, out + x);
    } else {
      for (; x < last; ++x) out[x] = pixel(above + x, row + x, below + x, cap);
    }
    out[0] = static_cast<std::uint8_t>(cap);
    out[last] = static_cast<std::uint8_t>(cap);
  }

 private:
  static std::uint8_t pixel(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                            int cap) {
    const int gradient = (above[1] - above[-1]) + 2 * (row[1] - row[-1]) + (below[1] - below[-1]);
    const int clipped = gradient < -cap ? -cap : gradient > cap ? cap : gradient;
    return static_cast<std::uint8_t>(clipped + cap);
  }
};

}  // namespace stereod::kernels
