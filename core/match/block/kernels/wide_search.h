// SPDX-License-Identifier: BSD-3-Clause
// The search for windows whose cost exceeds 16 bits: the same column sums, but window sums of 32 bits in
// memory. Each is cost·256 + disparity, so that the minimum tells both.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/block/kernels/column_sums.h"
#include "core/match/block/kernels/kernel.h"

namespace stereod::kernels {

template <typename V>
class WideSearch {
  using Reg = typename V::Reg;

 public:
  /// Kernel::add_row, and with kSearch Kernel::search_row, for Arithmetic::kWide: one chunk of whole vectors.
  /// kChunk: its size as a compile-time constant; 0 means SearchParams::chunk.
  template <bool kSearch, bool kRecompute, int kChunk>
  static void row(const SearchParams& params, const ColumnTile& tile, const RowChange& change,
                  const Scratch& scratch, const Winners& out) {
    Windows windows;
    if constexpr (kSearch) clear(params, tile.first, windows);
    const int padded = kChunk > 0 ? kChunk : params.chunk;
    const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(params.window) * padded;
    std::uint16_t* sums = sums_of(params, tile, scratch, 0, tile.first);
    Cursor<V, Arithmetic::kRaw, kRecompute> cursor(params, tile, change, 0, tile.first);
    for (int column = tile.first; column < tile.end; ++column, sums += padded) {
      const Reg left = V::broadcast8(*cursor.left);
      const Reg removed_left = kRecompute ? V::broadcast8(*cursor.removed_left) : left;
      if constexpr (kSearch) unlock(column - params.window + 1, params, windows);
      Reg minimum = V::broadcast16(0x7F7F);
#pragma GCC unroll 2
      for (int offset = 0; offset < padded; offset += V::kBytes) {
        Reg first, second;
        ColumnUpdate<V, Arithmetic::kRaw, kRecompute>::apply(cursor, offset, false, 0, left, removed_left,
                                                             sums + offset, first, second);
        if constexpr (kSearch) {
          first = V::sub16(first, V::load_aligned(sums + offset - back));
          second = V::sub16(second, V::load_aligned(sums + offset - back + V::kBytes / 2));
          slide(windows.sums + offset, first, second, minimum);
        }
      }
      cursor.next_column(padded);
      if constexpr (kSearch) {
        const int first_column = column - params.window + 1;
        if (first_column >= tile.first) {
          write_winner(V::horizontal_min32(minimum), first_column, params, windows, out);
        }
      }
    }
  }

 private:
  static constexpr int kMax = kMaxChunk * kMaxChunks;
  // Every sum starts at kBase, so that V::min32 may compare floating-point numbers. kLocked is added to the
  // sums of disparities that cannot be searched yet.
  static constexpr std::uint32_t kBase = 0x1000'0000, kLocked = 0x4000'0000;

  // Window sums in the order in which widening leaves the disparities, and the position of each disparity.
  // The positions of disparities −1 and kMax exist but are meaningless.
  struct Windows {
    alignas(64) std::uint32_t sums[kMax];
    std::uint8_t position_of[kMax + 2];
    std::uint8_t position(int k) const { return position_of[k + 1]; }
  };

  // Adds 16-bit changes to the sums of kBytes disparities.
  [[gnu::always_inline]] static inline void slide(std::uint32_t* sums, Reg first, Reg second, Reg& minimum) {
    const Reg changes[4] = {V::even_256(first), V::odd_256(first), V::even_256(second), V::odd_256(second)};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
      std::uint32_t* const lanes = sums + i * V::kBytes / 4;
      const Reg sum = V::add32(V::load_aligned(lanes), changes[i]);
      V::store_aligned(lanes, sum);
      minimum = V::min32(minimum, sum);
    }
  }

  // Empties the windows before the first column of the tile, and locks the disparities that lie outside the
  // right image there. The order is found by widening the numbers of the disparities.
  static void clear(const SearchParams& params, int first_column, Windows& windows) {
    alignas(64) std::uint8_t numbers[V::kBytes];
    for (int i = 0; i < V::kBytes; ++i) numbers[i] = static_cast<std::uint8_t>(i);
    windows.position_of[0] = windows.position_of[kMax + 1] = 0;
    for (int at = 0; at < params.chunk; at += V::kBytes) {
      Reg first = V::broadcast16(0), second = first, minimum = first;
      V::change_any(V::load_aligned(numbers), V::broadcast16(0), first, second);
      for (int i = 0; i < V::kBytes; ++i) windows.sums[at + i] = 0;
      slide(windows.sums + at, first, second, minimum);
      for (int i = at; i < at + V::kBytes; ++i) {
        const int k = at + static_cast<int>(windows.sums[i] >> 8);
        const bool inside = k < params.disparities && k <= first_column - params.window;
        windows.sums[i] = static_cast<std::uint32_t>(k) + kBase + (inside ? 0 : kLocked);
        windows.position_of[k + 1] = static_cast<std::uint8_t>(i);
      }
    }
  }

  // Unlocks disparity k, from the column on in which its window lies in the right image.
  static inline void unlock(int k, const SearchParams& params, Windows& windows) {
    if (k >= 0 && k < params.disparities) windows.sums[windows.position(k)] -= kLocked;
  }

  static inline void write_winner(std::uint32_t minimum, int column, const SearchParams& params,
                                  const Windows& windows, const Winners& out) {
    const int k = static_cast<int>(minimum & 0xFF);
    const std::uint32_t cost = cost_of(minimum);
    out.index[column] = static_cast<std::uint16_t>(k);
    out.cost[column] = cost;
    const std::uint32_t before = windows.sums[windows.position(k - 1)];
    const std::uint32_t after = windows.sums[windows.position(k + 1)];
    if (params.neighbors) {
      out.before[column] = cost_of(before);
      out.after[column] = cost_of(after);
    }
    if (params.uniqueness_ratio > 0) {
      const std::uint32_t limit = cost + cost * static_cast<std::uint32_t>(params.uniqueness_ratio) / 100;
      const std::uint32_t max_sum = kBase + (limit << 8 | 0xFF);
      const int expected =
          1 + (k > 0 && before <= max_sum) + (k + 1 < params.disparities && after <= max_sum);
      out.ambiguous[column] = count_up_to(max_sum, params, windows) > expected ? 1 : 0;
    }
  }

  static inline std::uint32_t cost_of(std::uint32_t sum) { return (sum - kBase) >> 8; }

  // Counts the sums that are ≤ `max_sum`.
  static inline int count_up_to(std::uint32_t max_sum, const SearchParams& params, const Windows& windows) {
    alignas(64) std::uint32_t counts[V::kBytes / 4];
    for (std::uint32_t& count : counts) count = max_sum;
    const Reg limit = V::load_aligned(counts);
    Reg above = V::broadcast16(0);  // a true lane is −1
    for (int i = 0; i < params.chunk; i += V::kBytes / 4) {
      above = V::add32(above, V::greater32(V::load_aligned(windows.sums + i), limit));
    }
    V::store_aligned(counts, above);
    std::uint32_t sum = static_cast<std::uint32_t>(params.chunk);
    for (const std::uint32_t count : counts) sum += count;
    return static_cast<int>(sum);
  }
};

}  // namespace stereod::kernels
