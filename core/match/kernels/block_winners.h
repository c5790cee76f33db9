// From the least sums of a block of columns to its winners: chunks brought together, neighbours, rivals.
#pragma once

#include <cstdint>

#include "core/match/kernels/column_sums.h"
#include "core/match/kernels/kernel.h"

namespace stereod::kernels {

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

template <typename V, Arithmetic kA>
class BlockWinners {
  using Reg = typename V::Reg;
  static constexpr int kLanes = V::kBytes / 2;

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

  // Writes the winners of a block's columns.
  static void write(const Shape& shape, const Scratch& scratch, const Block& block, const Best& best,
                    const Winners& out) {
    const int at = block.first - (shape.window - 1);
    const int count = block.end - block.first;
    count == kBlockColumns ? copy(best, kBlockColumns, out.index + at, out.cost + at)
                           : copy(best, count, out.index + at, out.cost + at);
    if (shape.neighbours) write_neighbours(shape, scratch, block, best, out);
    // Last, because it spoils the kept sums.
    if (shape.uniqueness_ratio > 0) write_ambiguous(shape, scratch, block, best, out);
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
  [[gnu::always_inline]] static inline void copy(const Best& __restrict best, int count,
                                                 std::uint16_t* __restrict index,
                                                 std::uint32_t* __restrict cost) {
    for (int i = 0; i < count; ++i) {
      index[i] = best.k[i];
      cost[i] = best.cost[i];
    }
  }

  static void write_neighbours(const Shape& shape, const Scratch& scratch, const Block& block,
                               const Best& best, const Winners& out) {
    const int count = block.end - block.first;
    const int at = block.first - (shape.window - 1);
    // First all three costs in one load, then apart in vectors.
    std::uint64_t three[kBlockColumns];
    const std::uint16_t* sums = scratch.block_sums;
    const int step = shape.block_step();
    for (int i = 0; i < count; ++i, sums += step) {
      __builtin_memcpy(&three[i], sums + best.k[i] - 1, sizeof(three[0]));
    }
    for (int i = 0; i < count; ++i) {
      out.before[at + i] = cost_of(static_cast<std::uint32_t>(three[i]) & 0xFFFF);
      out.after[at + i] = cost_of(static_cast<std::uint32_t>(three[i] >> 32) & 0xFFFF);
    }
  }

  static inline std::uint32_t cost_of(std::uint32_t sum) { return (sum ^ V::kBias) >> kShift; }

  // Whether the least sum of a column but for the winner's and its neighbours' is at most the limit.
  static void write_ambiguous(const Shape& shape, const Scratch& scratch, const Block& block,
                              const Best& best, const Winners& out) {
    const auto ratio = static_cast<std::uint32_t>(shape.uniqueness_ratio);
    std::uint16_t limits[kBlockColumns];  // as sums with the highest number of a group
    const int count = block.end - block.first;
    for (int i = 0; i < count; ++i) {
      const std::uint32_t cost = best.cost[i];
      const std::uint32_t limit = (cost + cost * ratio / 100) << kShift | kGroups;
      limits[i] = static_cast<std::uint16_t>((limit < 0xFFFE ? limit : 0xFFFE) ^ V::kBias);  // 0xFFFF: none
    }
    std::uint16_t* sums = scratch.block_sums;
    const int step = shape.block_step();
    const int searched = shape.padded_disparities();
    for (int i = 0; i < count; ++i) cover_winner(sums + i * step + best.k[i]);
    std::uint8_t* out_ambiguous = out.ambiguous + block.first - (shape.window - 1);
    for (int i = 0; i < count; ++i, sums += step) {
      Reg least = V::min16(V::load_aligned(sums), V::load_aligned(sums + kLanes));
      for (int k = 2 * kLanes; k < searched; k += 2 * kLanes) {
        least = V::min16(least, V::load_aligned(sums + k));
        least = V::min16(least, V::load_aligned(sums + k + kLanes));
      }
      out_ambiguous[i] = V::any_at_most(least, V::broadcast16(limits[i]));
    }
  }

  // Puts "no sum" over the winner's and those before and after it: four at once, of which the last stays.
  static inline void cover_winner(std::uint16_t* winner) {
    constexpr std::uint64_t kThree = 0x0000'FFFF'FFFF'FFFF;
    constexpr std::uint64_t kNoSums = 0x0001'0001'0001U * std::uint64_t{0xFFFF ^ V::kBias};
    std::uint64_t four;
    __builtin_memcpy(&four, winner - 1, sizeof(four));
    four = (four & ~kThree) | kNoSums;
    __builtin_memcpy(winner - 1, &four, sizeof(four));
  }
};

}  // namespace stereod::kernels
