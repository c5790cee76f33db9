// SPDX-License-Identifier: BSD-3-Clause
// The search. The window sums of all disparities of a chunk stay in registers along the row: the column sum
// that enters is added, the one `window` columns back is subtracted. Disparities are the lanes, so the winner
// is a minimum over lanes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/block/kernels/block_winners.h"
#include "core/match/block/kernels/column_sums.h"
#include "core/match/block/kernels/kernel.h"

namespace stereod::kernels {

/// Masks for the lanes of a chunk that cannot be searched: 0 for the first `searched` ones, 0xFFFF for the
/// others, plus bias.
template <typename V>
struct Masks {
  alignas(64) static constexpr auto kLanes = [] {
    struct {
      std::uint16_t lanes[2 * kMaxChunk];
    } mask{};
    for (int i = 0; i < kMaxChunk; ++i) mask.lanes[i] = V::kBias;
    for (int i = kMaxChunk; i < 2 * kMaxChunk; ++i) mask.lanes[i] = 0xFFFF ^ V::kBias;
    return mask;
  }();

  Masks(const SearchParams& params, int chunk)
      : before_first(params.window - 2 + params.first_of(chunk)),
        max_searched(params.disparities < params.chunk ? params.disparities : params.chunk) {}

  inline const std::uint16_t* for_column(int column) const {
    int searched = column - before_first;
    searched = searched < max_searched ? searched : max_searched;
    searched = searched > 0 ? searched : 0;
    return kLanes.lanes + kMaxChunk - searched;
  }

  int before_first;  // the column before the first one in which a disparity of the chunk can be searched
  int max_searched;  // disparities of the chunk that are searched
};

template <typename V, Arithmetic kA, int kVectors>
class BlockSearch {
  using Reg = typename V::Reg;
  static constexpr int kLanes = V::kBytes / 2;
  static constexpr int kChunk = kVectors * V::kBytes;
  static constexpr bool kEvenOdd = even_odd_order<V>(kA);
  static constexpr int kHalves = kA == Arithmetic::kPackedHalves ? 2 : 1;  // minima of a chunk

 public:
  static void row(const SearchParams& params, const ColumnTile& tile, const RowChange& change,
                  const Scratch& scratch, const Winners& out) {
    WindowSums window_sums[kMaxChunks];
    for (int chunk = 0; chunk < params.chunks; ++chunk) clear(window_sums[chunk]);
    BlockBest best;
    std::uint32_t minima[kHalves][kBlockColumns] = {};
    for (int first = tile.first, end = first; first < tile.end; first = end) {
      end = end_of_block(params, tile, first);
      for (int chunk = 0; chunk < params.chunks; ++chunk) {
        const ColumnBlock block{first, end};
        const Sweep sweep_block = sweep_for(params, block, chunk);
        sweep_block(params, tile, change, scratch, block, chunk, window_sums[chunk], minima);
        for (int half = 0; half < kHalves && first != tile.first; ++half) {
          BlockWinners<V, kA>::merge(minima[half], disparities_of(params, chunk, half),
                                     chunk == 0 && half == 0, best);
        }
      }
      if (first != tile.first) WinnerWriter<V>::write(params, scratch, {first, end}, best, out);
    }
  }

 private:
  // Returns the end of the block that begins at `first`. The first block of a tile holds the columns before
  // the first whole window. A block that would contain the end of the left border ends there, if that leaves
  // enough columns to be searched without masks.
  static int end_of_block(const SearchParams& params, const ColumnTile& tile, int first) {
    if (first == tile.first) return first + params.window - 1;
    constexpr int kMinColumns = 8;
    const int border_end = params.disparities + params.window - 2;
    int end = first + kBlockColumns;
    if (first < border_end && border_end + kMinColumns < end) end = border_end;
    return end < tile.end ? end : tile.end;
  }

  // Maps the lanes of a chunk, or of half of one, to disparities.
  static ChunkDisparities disparities_of(const SearchParams& params, int chunk, int half) {
    const int begin = half * (kChunk / kHalves);
    const int tail = tail_begin<V>(kA, kChunk);
    return {static_cast<std::int16_t>(params.first_of(chunk) + begin),
            static_cast<std::int16_t>(tail - begin),
            static_cast<std::int16_t>(tail - tail_disparity<V>(params))};
  }

  struct WindowSums;
  using Sweep = void (*)(const SearchParams&, const ColumnTile&, const RowChange&, const Scratch&,
                         const ColumnBlock&, int chunk, WindowSums&, std::uint32_t (*minima)[kBlockColumns]);

  // Returns the function for a block: at the left border fewer disparities can be searched than elsewhere.
  // Plain C++ has one function for all cases, to keep the program small; several are faster by a tenth at
  // most.
  static Sweep sweep_for(const SearchParams& params, const ColumnBlock& block, int chunk) {
    return params.recompute ? sweep_for<true>(params, block, chunk) : sweep_for<false>(params, block, chunk);
  }
  template <bool kRecompute>
  static Sweep sweep_for(const SearchParams& params, const ColumnBlock& block, int chunk) {
    if constexpr (requires { V::kOneSize; }) return sweep<kRecompute, true, kUnaligned>;
    const bool store = params.neighbors || params.uniqueness_ratio > 0;
    const int tail_overlap = tail_begin<V>(kA, kChunk) - tail_disparity<V>(params);
    const int lanes_end = params.first_of(chunk) + kChunk - tail_overlap;
    if (block.first - params.window + 2 < lanes_end || lanes_end > params.disparities) {
      return store ? sweep<kRecompute, true, kUnaligned> : sweep<kRecompute, true, kNoStore>;
    }
    if (!store) return sweep<kRecompute, false, kNoStore>;
    const bool aligned = tail_overlap == 0 && params.first_of(chunk) % kLanes == 0;
    return aligned ? sweep<kRecompute, false, kAligned> : sweep<kRecompute, false, kUnaligned>;
  }

  // How a sweep stores the sums to scratch.block_sums: not at all, in aligned vectors, or at the offsets that
  // the first disparity and the tail of the chunk require.
  enum StoreSums { kNoStore, kAligned, kUnaligned };

  // The window sums of a chunk between two blocks, register by register.
  struct alignas(64) WindowSums {
    std::uint16_t sums[kMaxChunk];
  };

  // Returns the number of the register that holds the `position`-th run of kLanes disparities of the chunk.
  static constexpr int register_of(int position) {
    if (!kEvenOdd) return position;
    return position < kVectors ? 2 * position : 2 * (position - kVectors) + 1;
  }

  // Clears the window sums. In packed arithmetic the low bits of each hold the number of its group of 8
  // lanes.
  static void clear(WindowSums& window_sums) {
    WindowSums ordered;
    for (int lane = 0; lane < kChunk; ++lane) {
      int sum = 0;
      if (kA == Arithmetic::kPacked) sum = lane / 8;
      if (kA == Arithmetic::kPackedHalves) sum = lane % (kChunk / 2) / 8;
      ordered.sums[lane] = static_cast<std::uint16_t>(sum + V::kBias);
    }
    for (int c = 0; c < kVectors; ++c) {
      Reg first, second;
      load_lanes(ordered.sums, c, tail_begin<V>(kA, kChunk), first, second);
      V::store_aligned(window_sums.sums + 2 * c * kLanes, first);
      V::store_aligned(window_sums.sums + (2 * c + 1) * kLanes, second);
    }
  }

  // Adds the row to the column sums of the block, slides the window along them and writes the minimum sum of
  // each column and its lane. kBorder: the disparities that can be searched differ from column to column.
  template <bool kRecompute, bool kBorder, StoreSums kStore>
  static void sweep(const SearchParams& params, const ColumnTile& tile, const RowChange& row,
                    const Scratch& scratch, const ColumnBlock& block, int chunk, WindowSums& window_sums,
                    std::uint32_t (*minima)[kBlockColumns]) {
    const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(params.window) * kChunk;
    const Masks<V> masks(params, chunk);
    const std::uint16_t* mask = nullptr;
    const int tail = kStore == kAligned ? tail_begin<V>(kA, kChunk) : tail_disparity<V>(params);
    Cursor<V, kA, kRecompute> cursor(params, tile, row, chunk, block.first);
    std::uint16_t* sums = sums_of(params, tile, scratch, chunk, block.first);
    std::uint16_t* stored_sums = scratch.block_sums + params.first_of(chunk);
    const int stored_step = params.block_step();
    Reg window[2 * kVectors];
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) window[i] = V::load_aligned(window_sums.sums + i * kLanes);

    for (int column = block.first; column < block.end; ++column) {
      const Reg left = V::broadcast8(*cursor.left);
      const Reg removed_left = kRecompute ? V::broadcast8(*cursor.removed_left) : left;
      if constexpr (kBorder) mask = masks.for_column(column);
      Reg candidates[2 * kVectors];
#pragma GCC unroll 4
      for (int c = 0; c < kVectors; ++c) {
        Reg first, second;
        std::uint16_t* const in = sums + c * V::kBytes;
        ColumnUpdate<V, kA, kRecompute>::apply(cursor, c * V::kBytes, c == kVectors - 1, tail, left,
                                               removed_left, in, first, second);
        Reg& lower = window[2 * c];
        Reg& upper = window[2 * c + 1];
        // Pinned so that the compiler does not subtract the old sum from the window sum instead, which would
        // need a copy of a register.
        first = V::sub16(first, V::load_aligned(in - back));
        second = V::sub16(second, V::load_aligned(in - back + kLanes));
        V::pin(first);
        V::pin(second);
        lower = V::add16(lower, first);
        upper = V::add16(upper, second);
        V::pin(lower);
        V::pin(upper);
        candidates[2 * c] = lower;
        candidates[2 * c + 1] = upper;
        if constexpr (kBorder) mask_lanes(mask, c, tail, candidates[2 * c], candidates[2 * c + 1]);
        if constexpr (kStore != kNoStore) {
          store_sums<kStore>(stored_sums, c, tail, candidates[2 * c], candidates[2 * c + 1]);
        }
      }
      find_minimum(candidates, column - block.first, minima);
      sums += kChunk;
      cursor.next_column(kChunk);
      if constexpr (kStore != kNoStore) stored_sums += stored_step;
    }
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) V::store_aligned(window_sums.sums + i * kLanes, window[i]);
  }

  // Loads the two registers of byte vector c from numbers in the order of disparities. The tail of the chunk
  // begins with number `tail`.
  [[gnu::always_inline]] static inline void load_lanes(const std::uint16_t* ordered, int c, int tail,
                                                       Reg& first, Reg& second) {
    if constexpr (kEvenOdd) {
      first = V::load(ordered + c * kLanes);
      second = V::load(ordered + tail + c * kLanes);
    } else {
      V::load_in_order(ordered + begin_of(c, tail), first, second);
    }
  }

  [[gnu::always_inline]] static inline void mask_lanes(const std::uint16_t* mask, int c, int tail, Reg& first,
                                                       Reg& second) {
    Reg first_mask, second_mask;
    load_lanes(mask, c, tail, first_mask, second_mask);
    first = V::masked(first, first_mask);
    second = V::masked(second, second_mask);
  }

  template <StoreSums kStore>
  [[gnu::always_inline]] static inline void store_sums(std::uint16_t* sums, int c, int tail, Reg first,
                                                       Reg second) {
    if constexpr (!kEvenOdd) {
      V::template store_in_order<kStore == kAligned>(sums + begin_of(c, tail), first, second);
    } else if constexpr (kStore == kAligned) {
      V::store_aligned(sums + c * kLanes, first);
      V::store_aligned(sums + tail + c * kLanes, second);
    } else {
      V::store(sums + c * kLanes, first);
      V::store(sums + tail + c * kLanes, second);
    }
  }

  // Returns the first disparity of byte vector c if vectors hold runs of disparities.
  [[gnu::always_inline]] static inline int begin_of(int c, int tail) {
    return c == kVectors - 1 ? tail : c * V::kBytes;
  }

  // Writes the minimum sum to the low half of a minimum, and to the high half its lane (packed) or its number
  // in the chunk (else).
  static inline void find_minimum(const Reg* sums, int column, std::uint32_t (*minima)[kBlockColumns]) {
    if constexpr (kHalves == 2) {
#pragma GCC unroll 2
      for (int half = 0; half < 2; ++half) {
        Reg minimum = sums[register_of(half * kVectors)];
#pragma GCC unroll 4
        for (int c = 1; c < kVectors; ++c)
          minimum = V::min16(minimum, sums[register_of(half * kVectors + c)]);
        minima[half][column] = V::horizontal_argmin16(minimum);
      }
    } else {
      // A chain, because a tree would need more copies of registers.
      Reg lowest = sums[0];
#pragma GCC unroll 8
      for (int i = 1; i < 2 * kVectors; ++i) lowest = V::min16(lowest, sums[i]);
      std::uint32_t minimum = V::horizontal_argmin16(lowest);
      if constexpr (kA != Arithmetic::kPacked) {
        const Reg wanted = V::broadcast16(static_cast<std::uint16_t>(minimum ^ V::kBias));
        minimum = (minimum & 0xFFFF) | V::template first_equal<kVectors, kEvenOdd>(sums, wanted) << 16;
      }
      minima[0][column] = minimum;
    }
  }
};

}  // namespace stereod::kernels
