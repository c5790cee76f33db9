// What happens to rows before they are compared: the prefilter, and the turning round of right rows.
#pragma once

#include <cstdint>

#include "core/match/kernels/column_sums.h"
#include "core/match/kernels/kernel.h"

namespace stereod::kernels {

/// xsobel_row() of core/match/prefilter.h, which is this. A plain loop that each instruction set's compiler
/// vectorises; Tag keeps their instantiations apart.
template <typename Tag>
void xsobel_row(const std::uint8_t* __restrict above, const std::uint8_t* __restrict row,
                const std::uint8_t* __restrict below, int width, int cap, std::uint8_t* __restrict out) {
  const auto limit = static_cast<std::int16_t>(cap);
  const auto most = static_cast<std::int16_t>(2 * cap);
  for (int x = 1; x < width - 1; ++x) {
    const auto gradient = static_cast<std::int16_t>(
        (above[x + 1] - above[x - 1]) + 2 * (row[x + 1] - row[x - 1]) + (below[x + 1] - below[x - 1]));
    const auto raised = static_cast<std::int16_t>(gradient + limit);
    const std::int16_t positive = raised > 0 ? raised : std::int16_t{0};
    out[x] = static_cast<std::uint8_t>(positive < most ? positive : most);
  }
  out[0] = static_cast<std::uint8_t>(cap);
  out[width - 1] = static_cast<std::uint8_t>(cap);
}

/// Kernel::prepare_right_row.
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
    if (interleaved) interleave(backwards, shape.chunk / 2, length, out);
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
