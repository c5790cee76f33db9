// What happens to rows before they are compared: the prefilter, and the turning round of right rows.
#pragma once

#include <cstdint>

#include "core/match/block/kernels/column_sums.h"
#include "core/match/block/kernels/kernel.h"

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
      x = last - V::kBytes;  // the rest, once more some of what is done already
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

/// How the disparities of right rows lie: Kernel::prepare_right_row.
template <typename V>
class RightRow {
 public:
  static void prepare(const Shape& shape, const std::uint8_t* right, std::uint8_t* out) {
    const int length = shape.width + shape.padded_disparities();
    const bool interleaved = even_odd_order<V>(shape.arithmetic);
    // Backwards first, into the upper half of the memory if more is to come: interleaving from there to the
    // front never writes what is still to be read.
    std::uint8_t* backwards = interleaved ? out + length : out;
    int p = 0;
    for (; p + 16 <= shape.width; p += 16) V::reverse16(right + shape.width - 16 - p, backwards + p);
    for (; p < shape.width; ++p) backwards[p] = right[shape.width - 1 - p];
    for (; p < length; ++p) backwards[p] = 0;
    if (interleaved) interleave(backwards, last_part_disparity<V>(shape), length, out);
  }

 private:
  // out[2p] = in[p], out[2p + 1] = in[p + half] for p < length, 0 where that lies beyond; in may be out +
  // length.
  static void interleave(const std::uint8_t* in, int half, int length, std::uint8_t* out) {
    int p = 0;
    for (; p + 16 <= length - half; p += 16) V::interleave16(in + p, in + half + p, out + 2 * p);
    for (; p < length; ++p) {
      const std::uint8_t lower = in[p];
      const std::uint8_t upper = p + half < length ? in[p + half] : std::uint8_t{0};
      out[2 * p] = lower;
      out[2 * p + 1] = upper;
    }
  }
};

}  // namespace stereod::kernels
