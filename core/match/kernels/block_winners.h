// From the least sums of a block of columns to its winners: chunks brought together, neighbours, rivals.
#pragma once

#include <cstdint>

#include "core/match/kernels/column_sums.h"
#include "core/match/kernels/kernel.h"

namespace stereod::kernels {

/// The columns [first, end), of a block that begins with column `base`.
struct Block {
  int first, end, base;
};

template <typename V, Arithmetic kA>
class BlockWinners {
  using Reg = typename V::Reg;

 public:
  // Brings found[] of disparities from `base` on to cost << 16 | k and keeps the lesser of it and best[].
  static void merge(const std::uint32_t* found, int count, std::uint32_t base, std::uint32_t* best) {
    // A whole block has a number of columns that the compiler knows: that saves it most of the work around a
    // vector loop.
    if (count == kBlockColumns) {
      base == 0 ? first_entries(found, kBlockColumns, best)
                : lesser_entries(found, kBlockColumns, base, best);
    } else {
      base == 0 ? first_entries(found, count, best) : lesser_entries(found, count, base, best);
    }
  }

  // Writes the winners of the block's columns whose window is complete.
  static void write(const Shape& shape, const Strip& strip, const Scratch& scratch, int first, int end,
                    const std::uint32_t* best, const Winners& out) {
    const int skip = shape.window - 1;  // columns before the first complete window
    const int begin = first > strip.first + skip ? first : strip.first + skip;
    if (end - begin == kBlockColumns) {
      split(best, kBlockColumns, out.index + (begin - skip), out.cost + (begin - skip));
    } else {
      split(best + (begin - first), end - begin, out.index + (begin - skip), out.cost + (begin - skip));
    }
    const Block block{begin, end, first};
    if (shape.neighbours) write_neighbours(shape, scratch, block, best, out);
    if (shape.uniqueness_ratio > 0) write_ambiguous(shape, scratch, block, best, out);
  }

 private:
  [[gnu::always_inline]] static inline std::uint32_t entry_of(std::uint32_t found, std::uint32_t base) {
    constexpr int kShift = shift_of(kA);
    constexpr std::uint32_t kGroups = (1U << kShift) - 1;
    const std::uint32_t cost = (found & 0xFFFF) >> kShift;
    return cost << 16 | (((found & kGroups) << 3) + (found >> 16) + base);
  }
  [[gnu::always_inline]] static inline void first_entries(const std::uint32_t* __restrict found, int count,
                                                          std::uint32_t* __restrict best) {
    for (int i = 0; i < count; ++i) best[i] = entry_of(found[i], 0);
  }
  [[gnu::always_inline]] static inline void lesser_entries(const std::uint32_t* __restrict found, int count,
                                                           std::uint32_t base,
                                                           std::uint32_t* __restrict best) {
    for (int i = 0; i < count; ++i) {
      const std::uint32_t entry = entry_of(found[i], base);
      best[i] = best[i] <= entry ? best[i] : entry;
    }
  }
  [[gnu::always_inline]] static inline void split(const std::uint32_t* __restrict best, int count,
                                                  std::uint16_t* __restrict index,
                                                  std::uint32_t* __restrict cost) {
    for (int i = 0; i < count; ++i) {
      index[i] = static_cast<std::uint16_t>(best[i]);
      cost[i] = best[i] >> 16;
    }
  }

  // The kept sums of the winner of column `column`.
  static inline const std::uint16_t* winner_sums(const Shape& shape, const Scratch& scratch,
                                                 const Block& block, const std::uint32_t* best, int column) {
    const int at = column - block.base;
    return scratch.block_sums + at * shape.padded_disparities() + (best[at] & 0xFFFF);
  }

  static void write_neighbours(const Shape& shape, const Scratch& scratch, const Block& block,
                               const std::uint32_t* best, const Winners& out) {
    const int skip = shape.window - 1;
    // First all three costs in one load, then apart in vectors.
    std::uint64_t three[kBlockColumns];
    for (int column = block.first; column < block.end; ++column) {
      __builtin_memcpy(&three[column - block.first], winner_sums(shape, scratch, block, best, column) - 1,
                       sizeof(three[0]));
    }
    std::uint32_t* before = out.before + block.first - skip;
    std::uint32_t* after = out.after + block.first - skip;
    for (int i = 0; i < block.end - block.first; ++i) {
      before[i] = cost_of(static_cast<std::uint32_t>(three[i]) & 0xFFFF);
      after[i] = cost_of(static_cast<std::uint32_t>(three[i] >> 32) & 0xFFFF);
    }
  }

  static inline std::uint32_t cost_of(std::uint32_t sum) { return (sum ^ V::kBias) >> shift_of(kA); }

  // Compares all kept sums of a column with the limit and looks whether any but the winner's and its
  // neighbours' is below.
  static void write_ambiguous(const Shape& shape, const Scratch& scratch, const Block& block,
                              const std::uint32_t* best, const Winners& out) {
    constexpr std::uint32_t kGroups = (1U << shift_of(kA)) - 1;
    const auto ratio = static_cast<std::uint32_t>(shape.uniqueness_ratio);
    std::uint32_t limits[kBlockColumns];  // as sums with the highest number of a group, without bias
    for (int i = 0; i < block.end - block.base; ++i) {
      const std::uint32_t cost = best[i] >> 16;
      const std::uint32_t limit = (cost + cost * ratio / 100) << shift_of(kA) | kGroups;
      limits[i] = limit < 0xFFFE ? limit : 0xFFFE;  // 0xFFFF is what cannot be searched
    }
    const std::uint16_t* sums = scratch.block_sums;
    const int chunks = shape.chunks;
    const int chunk_size = shape.chunk;
    std::uint8_t* out_ambiguous = out.ambiguous + block.base - (shape.window - 1);
    for (int i = 0; i < block.end - block.base; ++i) {
      const Reg limit = V::broadcast16(static_cast<std::uint16_t>(limits[i] ^ V::kBias));
      const int winner = static_cast<int>(best[i] & 0xFFFF);
      std::uint64_t rivals = 0;
      for (int chunk = 0; chunk < chunks; ++chunk, sums += chunk_size) {
        rivals |= at_most(sums, limit, chunk_size) & ~beside(winner - chunk * chunk_size);
      }
      if (i >= block.first - block.base) out_ambiguous[i] = rivals != 0 ? 1 : 0;
    }
  }

  // A bit for each sum of a chunk.
  static inline std::uint64_t at_most(const std::uint16_t* sums, Reg limit, int chunk_size) {
    std::uint64_t bits = 0;
    for (int k = 0; k < chunk_size; k += V::kBytes) bits |= std::uint64_t{V::at_most(sums + k, limit)} << k;
    return bits;
  }

  // The bits k − 1, k and k + 1, as far as there are such.
  static inline std::uint64_t beside(int k) {
    constexpr std::uint64_t kOne = 1;
    if (k >= 0 && k < 64) return kOne << k | kOne << k << 1 | kOne << k >> 1;
    if (k == -1) return kOne;
    return k == 64 ? kOne << 63 : 0;
  }
};

}  // namespace stereod::kernels
