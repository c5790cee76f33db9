// From the least sums of a block of columns to its winners: chunks brought together, neighbors, rivals.
#pragma once

#include <cstdint>

#include "core/match/block/kernels/column_sums.h"
#include "core/match/block/kernels/kernel.h"

namespace stereod::kernels {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);  // of sums read several at once the first is lowest

/// The columns [first, end).
struct Block {
  int first, end;
};

/// Which disparities places in a chunk are: `first` + place, but from place `last` on `back` less.
struct Places {
  std::int16_t first, last, back;
};

/// Of each column of a block the least cost and its disparity, the lowest on a tie.
struct Best {
  std::uint16_t k[kBlockColumns];
  std::uint16_t cost[kBlockColumns];
};

/// From what a sweep found to the best so far.
template <typename V, Arithmetic kA>
class BlockWinners {
 public:
  // Keeps of found[] what is less than the best so far; the first has nothing to be less than. Whole blocks,
  // whatever a block has: a number of columns that the compiler knows saves most of the work around a vector
  // loop.
  static void merge(const std::uint32_t* __restrict found, Places places, bool first, Best& __restrict best) {
    for (int i = 0; first && i < kBlockColumns; ++i) {
      best.k[i] = disparity_found(found[i], places);
      best.cost[i] = cost_found(found[i]);
    }
    for (int i = 0; !first && i < kBlockColumns; ++i) {
      const std::uint16_t k = disparity_found(found[i], places);
      const std::uint16_t cost = cost_found(found[i]);
      // On a tie that found before is the lower disparity, or the same.
      const bool less = cost < best.cost[i];
      best.k[i] = less ? k : best.k[i];
      best.cost[i] = less ? cost : best.cost[i];
    }
  }

 private:
  static constexpr int kShift = shift_of(kA);
  static constexpr std::uint32_t kGroups = (1U << kShift) - 1;

  // In 16 bits, of which twice as many fit in a vector as of 32.
  [[gnu::always_inline]] static inline std::uint16_t cost_found(std::uint32_t found) {
    return static_cast<std::uint16_t>(static_cast<std::uint16_t>(found) >> kShift);
  }
  [[gnu::always_inline]] static inline std::uint16_t disparity_found(std::uint32_t found, Places places) {
    const auto group = static_cast<std::int16_t>((found & kGroups) << 3);
    const auto place = static_cast<std::int16_t>(group + static_cast<std::int16_t>(found >> 16));
    const std::int16_t back = place < places.last ? std::int16_t{0} : places.back;
    return static_cast<std::uint16_t>(places.first + place - back);
  }
};

/// From the best of all chunks to Winners. One for all arithmetics, to be small.
template <typename V>
class WinnerWriter {
  using Reg = typename V::Reg;
  static constexpr int kLanes = V::kBytes / 2;

 public:
  // Writes the winners of a block's columns, and over what may be written over after them: loops over a whole
  // block's columns need no beginnings and ends. Not inlined into its many callers: that would only be
  // larger.
  [[gnu::noinline]] static void write(const Shape& shape, const Scratch& scratch, const Block& block,
                                      const Best& best, const Winners& out) {
    const int at = block.first - (shape.window - 1);
    const int count = block.end - block.first;
    copy(best, out.index + at, out.cost + at);
    std::uint64_t around[kBlockColumns];
    for (int i = count; i < kBlockColumns; ++i) around[i] = 0;
    if (shape.uniqueness_ratio > 0) {
      look_around<true>(shape, scratch, best, count, around);
      write_ambiguous(shape, scratch, best, count, out.ambiguous + at);
    } else if (shape.neighbors) {
      look_around<false>(shape, scratch, best, count, around);
    }
    if (shape.neighbors) {
      copy_neighbors(around, shift_of(shape.arithmetic), out.before + at, out.after + at);
    }
  }

 private:
  static inline void copy(const Best& __restrict best, std::uint16_t* __restrict index,
                          std::uint32_t* __restrict cost) {
    for (int i = 0; i < kBlockColumns; ++i) {
      index[i] = best.k[i];
      cost[i] = best.cost[i];
    }
  }
  static inline void copy_neighbors(const std::uint64_t* __restrict around, int shift,
                                    std::uint32_t* __restrict before, std::uint32_t* __restrict after) {
    constexpr std::uint32_t kBias = V::kBias;
    for (int i = 0; i < kBlockColumns; ++i) {
      before[i] = ((static_cast<std::uint32_t>(around[i]) & 0xFFFF) ^ kBias) >> shift;
      after[i] = ((static_cast<std::uint32_t>(around[i] >> 32) & 0xFFFF) ^ kBias) >> shift;
    }
  }

  // Reads four sums in one load, the second of which is the winner's, and if kCover puts "no sum" over the
  // winner's and those before and after it.
  template <bool kCover>
  static void look_around(const Shape& shape, const Scratch& scratch, const Best& best, int count,
                          std::uint64_t* around) {
    constexpr std::uint64_t kThree = 0x0000'FFFF'FFFF'FFFF;
    constexpr std::uint64_t kNoSums = 0x0001'0001'0001U * std::uint64_t{0xFFFF ^ V::kBias};
    std::uint16_t* sums = scratch.block_sums - 1;
    const int step = shape.block_step();
#pragma GCC unroll 2
    for (int i = 0; i < count; ++i, sums += step) {
      std::uint64_t four;
      __builtin_memcpy(&four, sums + best.k[i], sizeof(four));
      around[i] = four;
      if constexpr (kCover) {
        four = (four & ~kThree) | kNoSums;
        __builtin_memcpy(sums + best.k[i], &four, sizeof(four));
      }
    }
  }

  // Whether the least of the sums that are not covered is at most the limit.
  static void write_ambiguous(const Shape& shape, const Scratch& scratch, const Best& best, int count,
                              std::uint8_t* __restrict ambiguous) {
    std::uint16_t rivals[kBlockColumns];
    for (int i = count; i < kBlockColumns; ++i) rivals[i] = 0;
    // The usual number of disparities has no loop over them.
    const int searched = shape.padded_disparities();
    searched == kMaxChunk ? find_rivals(shape, scratch, count, kMaxChunk, rivals)
                          : find_rivals(shape, scratch, count, searched, rivals);
    // cost + cost·ratio / 100, without the division, and with rounding as if there were one.
    const auto percent = static_cast<std::uint32_t>(100 + shape.uniqueness_ratio);
    const int shift = shift_of(shape.arithmetic);
    for (int i = 0; i < kBlockColumns; ++i) {
      const auto rival = static_cast<std::uint32_t>(rivals[i] >> shift);
      ambiguous[i] = (rival * 100 <= best.cost[i] * percent) & (rivals[i] != 0xFFFF);
    }
  }

  // Of each column the least sum, without bias.
  [[gnu::always_inline]] static inline void find_rivals(const Shape& shape, const Scratch& scratch, int count,
                                                        int searched, std::uint16_t* rivals) {
    const std::uint16_t* sums = scratch.block_sums;
    const int step = shape.block_step();
    for (int i = 0; i < count; ++i, sums += step) {
      Reg least = V::min16(V::load_aligned(sums), V::load_aligned(sums + kLanes));
#pragma GCC unroll 4
      for (int k = 2 * kLanes; k < searched; k += 2 * kLanes) {
        least = V::min16(least, V::load_aligned(sums + k));
        least = V::min16(least, V::load_aligned(sums + k + kLanes));
      }
      rivals[i] = V::least16(least);
    }
  }
};

}  // namespace stereod::kernels
