// SPDX-License-Identifier: BSD-3-Clause
// From the minimum sums of a block of columns to its winners: merging of chunks, neighbors, rivals.
#pragma once

#include <cstdint>

#include "core/match/block/kernels/column_sums.h"
#include "core/match/block/kernels/kernel.h"

namespace stereod::kernels {

static_assert(__BYTE_ORDER__ ==
              __ORDER_LITTLE_ENDIAN__);  // the first of several sums in one load is the lowest

/// The columns [first, end).
struct ColumnBlock {
  int first, end;
};

/// Maps lanes of a chunk, or of half of one, to disparities: `first` + lane, less `tail_overlap` from lane
/// `tail_begin` on.
struct ChunkDisparities {
  std::int16_t first, tail_begin, tail_overlap;
};

/// The minimum cost of each column of a block and its disparity, the lowest on a tie.
struct BlockBest {
  std::uint16_t k[kBlockColumns];
  std::uint16_t cost[kBlockColumns];
};

/// Merges the minima of a sweep into the best of the chunks before.
template <typename V, Arithmetic kA>
class BlockWinners {
 public:
  // Takes the minima that are lower than the best so far, or all of the first sweep. Always works on whole
  // blocks: a compile-time number of columns saves most of the code around a vector loop.
  static void merge(const std::uint32_t* __restrict minima, ChunkDisparities map, bool first,
                    BlockBest& __restrict best) {
    for (int i = 0; first && i < kBlockColumns; ++i) {
      best.k[i] = disparity_of(minima[i], map);
      best.cost[i] = cost_of(minima[i]);
    }
    for (int i = 0; !first && i < kBlockColumns; ++i) {
      const std::uint16_t k = disparity_of(minima[i], map);
      const std::uint16_t cost = cost_of(minima[i]);
      // On a tie the best so far has the lower disparity, or the same one.
      const bool less = cost < best.cost[i];
      best.k[i] = less ? k : best.k[i];
      best.cost[i] = less ? cost : best.cost[i];
    }
  }

 private:
  static constexpr int kShift = shift_of(kA);
  static constexpr std::uint32_t kGroups = (1U << kShift) - 1;

  // In 16 bits, because a vector holds twice as many lanes of them as of 32.
  [[gnu::always_inline]] static inline std::uint16_t cost_of(std::uint32_t minimum) {
    return static_cast<std::uint16_t>(static_cast<std::uint16_t>(minimum) >> kShift);
  }
  [[gnu::always_inline]] static inline std::uint16_t disparity_of(std::uint32_t minimum,
                                                                  ChunkDisparities map) {
    const auto group = static_cast<std::int16_t>((minimum & kGroups) << 3);
    const auto lane = static_cast<std::int16_t>(group + static_cast<std::int16_t>(minimum >> 16));
    const std::int16_t overlap = lane < map.tail_begin ? std::int16_t{0} : map.tail_overlap;
    return static_cast<std::uint16_t>(map.first + lane - overlap);
  }
};

/// Writes Winners from the best of all chunks. One for all arithmetics, to keep the program small.
template <typename V>
class WinnerWriter {
  using Reg = typename V::Reg;
  static constexpr int kLanes = V::kBytes / 2;

 public:
  // Writes the winners of the columns of a block, and overwrites up to a whole block, so that loops have a
  // compile-time length. Not inlined into its many callers, to keep the program small.
  [[gnu::noinline]] static void write(const SearchParams& params, const Scratch& scratch,
                                      const ColumnBlock& block, const BlockBest& best, const Winners& out) {
    const int first = block.first - (params.window - 1);
    const int count = block.end - block.first;
    copy(best, out.index + first, out.cost + first);
    std::uint64_t neighborhoods[kBlockColumns];
    for (int i = count; i < kBlockColumns; ++i) neighborhoods[i] = 0;
    if (params.uniqueness_ratio > 0) {
      load_neighbors<true>(params, scratch, best, count, neighborhoods);
      write_ambiguous(params, scratch, best, count, out.ambiguous + first);
    } else if (params.neighbors) {
      load_neighbors<false>(params, scratch, best, count, neighborhoods);
    }
    if (params.neighbors) {
      copy_neighbors(neighborhoods, shift_of(params.arithmetic), out.before + first, out.after + first);
    }
  }

 private:
  static inline void copy(const BlockBest& __restrict best, std::uint16_t* __restrict index,
                          std::uint32_t* __restrict cost) {
    for (int i = 0; i < kBlockColumns; ++i) {
      index[i] = best.k[i];
      cost[i] = best.cost[i];
    }
  }
  static inline void copy_neighbors(const std::uint64_t* __restrict neighborhoods, int shift,
                                    std::uint32_t* __restrict before, std::uint32_t* __restrict after) {
    constexpr std::uint32_t kBias = V::kBias;
    for (int i = 0; i < kBlockColumns; ++i) {
      before[i] = ((static_cast<std::uint32_t>(neighborhoods[i]) & 0xFFFF) ^ kBias) >> shift;
      after[i] = ((static_cast<std::uint32_t>(neighborhoods[i] >> 32) & 0xFFFF) ^ kBias) >> shift;
    }
  }

  // Loads four sums of each column at once, the second of which is the winner's. kMaskWinner also overwrites
  // the winner's sum and its two neighbors with "no sum".
  template <bool kMaskWinner>
  static void load_neighbors(const SearchParams& params, const Scratch& scratch, const BlockBest& best,
                             int count, std::uint64_t* neighborhoods) {
    constexpr std::uint64_t kThree = 0x0000'FFFF'FFFF'FFFF;
    constexpr std::uint64_t kNoSums = 0x0001'0001'0001U * std::uint64_t{0xFFFF ^ V::kBias};
    std::uint16_t* sums = scratch.block_sums - 1;
    const int step = params.block_step();
#pragma GCC unroll 2
    for (int i = 0; i < count; ++i, sums += step) {
      std::uint64_t four;
      __builtin_memcpy(&four, sums + best.k[i], sizeof(four));
      neighborhoods[i] = four;
      if constexpr (kMaskWinner) {
        four = (four & ~kThree) | kNoSums;
        __builtin_memcpy(sums + best.k[i], &four, sizeof(four));
      }
    }
  }

  // Writes whether the minimum of the sums that are not masked is within the uniqueness limit.
  static void write_ambiguous(const SearchParams& params, const Scratch& scratch, const BlockBest& best,
                              int count, std::uint8_t* __restrict ambiguous) {
    std::uint16_t rivals[kBlockColumns];
    for (int i = count; i < kBlockColumns; ++i) rivals[i] = 0;
    // The usual number of disparities has no loop: it is a compile-time constant.
    const int searched = params.padded_disparities();
    searched == kMaxChunk ? find_rivals(params, scratch, count, kMaxChunk, rivals)
                          : find_rivals(params, scratch, count, searched, rivals);
    // rival ≤ cost + cost·ratio / 100, rounded down, without a division.
    const auto percent = static_cast<std::uint32_t>(100 + params.uniqueness_ratio);
    const int shift = shift_of(params.arithmetic);
    for (int i = 0; i < kBlockColumns; ++i) {
      const auto rival = static_cast<std::uint32_t>(rivals[i] >> shift);
      ambiguous[i] = (rival * 100 <= best.cost[i] * percent) & (rivals[i] != 0xFFFF);
    }
  }

  // Writes the minimum sum of each column, without bias.
  [[gnu::always_inline]] static inline void find_rivals(const SearchParams& params, const Scratch& scratch,
                                                        int count, int searched, std::uint16_t* rivals) {
    const std::uint16_t* sums = scratch.block_sums;
    const int step = params.block_step();
    for (int i = 0; i < count; ++i, sums += step) {
      Reg minimum = V::min16(V::load_aligned(sums), V::load_aligned(sums + kLanes));
#pragma GCC unroll 4
      for (int k = 2 * kLanes; k < searched; k += 2 * kLanes) {
        minimum = V::min16(minimum, V::load_aligned(sums + k));
        minimum = V::min16(minimum, V::load_aligned(sums + k + kLanes));
      }
      rivals[i] = V::horizontal_min16(minimum);
    }
  }
};

}  // namespace stereod::kernels
