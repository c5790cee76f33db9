// The search for windows whose cost overflows 16 bits: the same method with 32-bit sums in plain loops over
// the disparities, which the compiler vectorises.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/kernels/column_sums.h"
#include "core/match/kernels/kernel.h"

namespace stereod::kernels {

/// Tag keeps the instantiations of differently compiled files apart.
template <typename Tag>
class WideSearch {
 public:
  template <bool kSearch>
  static void row(const Shape& shape, const Strip& strip, const RowChange& change, const Scratch& scratch,
                  const Winners& out) {
    std::uint32_t window[kMaxChunk * kMaxChunks] = {};
    const int padded = shape.padded_disparities();
    const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(shape.window) * padded;
    std::uint16_t* sums = sums_of(shape, strip, scratch, 0, strip.first);
    std::uint8_t* differences = change.differences;
    const std::uint8_t* removed = change.removed_differences;
    for (int column = strip.first; column < strip.end;
         ++column, sums += padded, differences += padded, removed += padded) {
      const int left = change.added.left[column];
      const std::uint8_t* right = change.added.right + (shape.width - 1 - column);
      for (int k = 0; k < padded; ++k) {
        const int added = left > right[k] ? left - right[k] : right[k] - left;
        sums[k] = static_cast<std::uint16_t>(sums[k] + added - removed[k]);
        differences[k] = static_cast<std::uint8_t>(added);
      }
      if constexpr (kSearch) {
        for (int k = 0; k < padded; ++k) window[k] += static_cast<std::uint32_t>(sums[k]) - sums[k - back];
        const int at = column - shape.window + 1;
        if (at >= strip.first) {
          write_winner(window, at + 1 < shape.disparities ? at + 1 : shape.disparities, at, shape, out);
        }
      }
    }
  }

 private:
  static void write_winner(const std::uint32_t* costs, int searched, int at, const Shape& shape,
                           const Winners& out) {
    std::uint32_t least = costs[0];
    for (int k = 1; k < searched; ++k) least = costs[k] < least ? costs[k] : least;
    int best = 0;
    while (costs[best] != least) ++best;
    out.index[at] = static_cast<std::uint16_t>(best);
    out.cost[at] = least;
    if (shape.neighbours) {
      out.before[at] = best > 0 ? costs[best - 1] : 0;
      out.after[at] = best + 1 < searched ? costs[best + 1] : 0;
    }
    if (shape.uniqueness_ratio > 0) {
      std::uint32_t rival = 0xFFFFFFFFu;
      for (int k = 0; k < best - 1; ++k) rival = costs[k] < rival ? costs[k] : rival;
      for (int k = best + 2; k < searched; ++k) rival = costs[k] < rival ? costs[k] : rival;
      const std::uint32_t limit = least + least * static_cast<std::uint32_t>(shape.uniqueness_ratio) / 100;
      out.ambiguous[at] = rival <= limit ? 1 : 0;
    }
  }
};

}  // namespace stereod::kernels
