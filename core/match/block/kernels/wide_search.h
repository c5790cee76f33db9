// The search for windows whose cost overflows 16 bits: the same column sums, window sums of 32 bits in
// memory, each of them cost·256 + disparity, so that the minimum tells both.
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
  /// Kernel::add_row, and with kSearch Kernel::search_row, for kWide: one chunk, of whole vectors. kChunk:
  /// how many disparities, where the compiler is to know; 0: Shape::chunk.
  template <bool kSearch, bool kRecompute, int kChunk>
  static void row(const Shape& shape, const Strip& strip, const RowChange& change, const Scratch& scratch,
                  const Winners& out) {
    Windows windows;
    if constexpr (kSearch) start(shape, strip.first, windows);
    const int padded = kChunk > 0 ? kChunk : shape.chunk;
    const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(shape.window) * padded;
    std::uint16_t* sums = sums_of(shape, strip, scratch, 0, strip.first);
    Place<V, Arithmetic::kRaw, kRecompute> place(shape, strip, change, 0, strip.first);
    for (int column = strip.first; column < strip.end; ++column, sums += padded) {
      const Reg left = V::broadcast8(*place.left);
      const Reg removed_left = kRecompute ? V::broadcast8(*place.removed_left) : left;
      if constexpr (kSearch) let_in(column - shape.window + 1, shape, windows);
      Reg least = V::broadcast16(0x7F7F);
#pragma GCC unroll 2
      for (int at = 0; at < padded; at += V::kBytes) {
        Reg first, second;
        ColumnUpdate<V, Arithmetic::kRaw, kRecompute>::apply(place, at, false, 0, left, removed_left,
                                                             sums + at, first, second);
        if constexpr (kSearch) {
          first = V::sub16(first, V::load_aligned(sums + at - back));
          second = V::sub16(second, V::load_aligned(sums + at - back + V::kBytes / 2));
          slide(windows.sums + at, first, second, least);
        }
      }
      place.next_column(padded);
      if constexpr (kSearch) {
        const int at = column - shape.window + 1;
        if (at >= strip.first) write_winner(V::least32(least), at, shape, windows, out);
      }
    }
  }

 private:
  static constexpr int kMax = kMaxChunk * kMaxChunks;
  // Every sum begins with kBase, so that V::min32 may take them for floating-point numbers; kShut is added to
  // those that are shut out.
  static constexpr std::uint32_t kBase = 0x1000'0000, kShut = 0x4000'0000;

  // Window sums in the order in which widening leaves the disparities, and where each of them is. The places
  // of disparities −1 and kMax are of no meaning, but there.
  struct Windows {
    alignas(64) std::uint32_t sums[kMax];
    std::uint8_t place_of[kMax + 2];
    std::uint8_t place(int k) const { return place_of[k + 1]; }
  };

  // Adds 16-bit changes to the sums of kBytes disparities.
  [[gnu::always_inline]] static inline void slide(std::uint32_t* sums, Reg first, Reg second, Reg& least) {
    const Reg changes[4] = {V::even_256(first), V::odd_256(first), V::even_256(second), V::odd_256(second)};
#pragma GCC unroll 4
    for (int i = 0; i < 4; ++i) {
      std::uint32_t* const at = sums + i * V::kBytes / 4;
      const Reg sum = V::add32(V::load_aligned(at), changes[i]);
      V::store_aligned(at, sum);
      least = V::min32(least, sum);
    }
  }

  // Empty windows before the strip's first column; shut out are disparities that lie outside the right
  // image there. The order is what comes out where the numbers of disparities go in.
  static void start(const Shape& shape, int first_column, Windows& windows) {
    alignas(64) std::uint8_t numbers[V::kBytes];
    for (int i = 0; i < V::kBytes; ++i) numbers[i] = static_cast<std::uint8_t>(i);
    windows.place_of[0] = windows.place_of[kMax + 1] = 0;
    for (int at = 0; at < shape.chunk; at += V::kBytes) {
      Reg first = V::broadcast16(0), second = first, least = first;
      V::change_any(V::load_aligned(numbers), V::broadcast16(0), first, second);
      for (int i = 0; i < V::kBytes; ++i) windows.sums[at + i] = 0;
      slide(windows.sums + at, first, second, least);
      for (int i = at; i < at + V::kBytes; ++i) {
        const int k = at + static_cast<int>(windows.sums[i] >> 8);
        const bool inside = k < shape.disparities && k <= first_column - shape.window;
        windows.sums[i] = static_cast<std::uint32_t>(k) + kBase + (inside ? 0 : kShut);
        windows.place_of[k + 1] = static_cast<std::uint8_t>(i);
      }
    }
  }

  // From the column on in which its window is whole, a disparity is searched.
  static inline void let_in(int k, const Shape& shape, Windows& windows) {
    if (k >= 0 && k < shape.disparities) windows.sums[windows.place(k)] -= kShut;
  }

  static inline void write_winner(std::uint32_t least, int at, const Shape& shape, const Windows& windows,
                                  const Winners& out) {
    const int k = static_cast<int>(least & 0xFF);
    const std::uint32_t cost = cost_of(least);
    out.index[at] = static_cast<std::uint16_t>(k);
    out.cost[at] = cost;
    const std::uint32_t before = windows.sums[windows.place(k - 1)];
    const std::uint32_t after = windows.sums[windows.place(k + 1)];
    if (shape.neighbors) {
      out.before[at] = cost_of(before);
      out.after[at] = cost_of(after);
    }
    if (shape.uniqueness_ratio > 0) {
      const std::uint32_t limit = cost + cost * static_cast<std::uint32_t>(shape.uniqueness_ratio) / 100;
      const std::uint32_t most = kBase + (limit << 8 | 0xFF);
      const int expected = 1 + (k > 0 && before <= most) + (k + 1 < shape.disparities && after <= most);
      out.ambiguous[at] = at_most(most, shape, windows) > expected ? 1 : 0;
    }
  }

  static inline std::uint32_t cost_of(std::uint32_t sum) { return (sum - kBase) >> 8; }

  // How many sums are at most this.
  static inline int at_most(std::uint32_t most, const Shape& shape, const Windows& windows) {
    alignas(64) std::uint32_t counts[V::kBytes / 4];
    for (std::uint32_t& count : counts) count = most;
    const Reg limit = V::load_aligned(counts);
    Reg above = V::broadcast16(0);  // −1 for each
    for (int i = 0; i < shape.chunk; i += V::kBytes / 4) {
      above = V::add32(above, V::greater32(V::load_aligned(windows.sums + i), limit));
    }
    V::store_aligned(counts, above);
    std::uint32_t sum = static_cast<std::uint32_t>(shape.chunk);
    for (const std::uint32_t count : counts) sum += count;
    return static_cast<int>(sum);
  }
};

}  // namespace stereod::kernels
