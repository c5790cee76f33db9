// SPDX-License-Identifier: BSD-3-Clause
// Right rows in the order in which the kernels read them.
#pragma once

#include <cstdint>

#include "core/match/block/kernels/column_sums.h"
#include "core/match/block/kernels/kernel.h"

namespace stereod::kernels {

/// Kernel::prepare_right_row.
template <typename V>
class RightRow {
 public:
  static void prepare(const SearchParams& params, const std::uint8_t* right, std::uint8_t* out) {
    const int length = params.width + params.padded_disparities();
    const bool interleaved = even_odd_order<V>(params.arithmetic);
    // Reverses into the upper half of the memory if bytes are to be interleaved: interleaving from there to
    // the lower half never overwrites bytes that are still to be read.
    std::uint8_t* reversed = interleaved ? out + length : out;
    int p = 0;
    for (; p + 16 <= params.width; p += 16) V::reverse16(right + params.width - 16 - p, reversed + p);
    for (; p < params.width; ++p) reversed[p] = right[params.width - 1 - p];
    for (; p < length; ++p) reversed[p] = 0;
    if (interleaved) interleave(reversed, tail_disparity<V>(params), length, out);
  }

 private:
  // Writes out[2p] = in[p] and out[2p + 1] = in[p + half] for p < length, 0 where that exceeds the length.
  // `in` may be out + length.
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
