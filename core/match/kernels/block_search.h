// The search: along the row the window's sums of all disparities of a chunk stay in registers: the column sum
// that comes in is added, the one `window` columns back subtracted. Disparities are the lanes, so the winner
// is a minimum over lanes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/kernels/column_sums.h"
#include "core/match/kernels/kernel.h"

namespace stereod::kernels {

/// Masks for the lanes of a chunk that cannot be searched: zeros for the first `searched` ones, ones for the
/// others (plus bias).
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

  Masks(const Shape& shape, int chunk)
      : before_first(shape.window - 2 + chunk * shape.chunk),
        most(shape.disparities - chunk * shape.chunk < shape.chunk ? shape.disparities - chunk * shape.chunk
                                                                   : shape.chunk) {}

  inline const std::uint16_t* at(int column) const {
    int searched = column - before_first;
    searched = searched < most ? searched : most;
    searched = searched > 0 ? searched : 0;
    return kLanes.lanes + kMaxChunk - searched;
  }

  int before_first;  // the column before the first one in which a disparity of the chunk can be searched
  int most;          // disparities of the chunk that can be searched anywhere
};

template <typename V, Arithmetic kA, bool kRecompute, int kVectors>
class BlockSearch {
  using Reg = typename V::Reg;
  static constexpr int kLanes = V::kBytes / 2;
  static constexpr int kChunk = kVectors * V::kBytes;
  static constexpr bool kEvenOdd = even_odd_order<V>(kA);
  static constexpr int kHalves = kA == Arithmetic::kPackedHalves ? 2 : 1;  // minima of a chunk

 public:
  static void row(const Shape& shape, const Strip& strip, const RowChange& change, const Scratch& scratch,
                  const Winners& out) {
    Running running[kMaxChunks];
    for (int chunk = 0; chunk < shape.chunks; ++chunk) start(running[chunk]);
    const bool keep_sums = shape.neighbours || shape.uniqueness_ratio > 0;
    for (int first = strip.first; first < strip.end; first += kBlockColumns) {
      const int end = first + kBlockColumns < strip.end ? first + kBlockColumns : strip.end;
      std::uint32_t best[kBlockColumns];  // cost << 16 | k: the least is the winner, the lowest k on a tie
      for (int chunk = 0; chunk < shape.chunks; ++chunk) {
        const Block block{first, end, first};
        // All disparities of the chunk can be searched in every column of the block, or some lanes are
        // masked.
        const int chunk_end = (chunk + 1) * kChunk;
        const bool masked = chunk_end > shape.disparities || first - shape.window + 2 < chunk_end;
        std::uint32_t found[kHalves][kBlockColumns];
        if (keep_sums) {
          masked ? sweep<true, true>(shape, strip, change, scratch, block, chunk, running[chunk], found)
                 : sweep<false, true>(shape, strip, change, scratch, block, chunk, running[chunk], found);
        } else {
          masked ? sweep<true, false>(shape, strip, change, scratch, block, chunk, running[chunk], found)
                 : sweep<false, false>(shape, strip, change, scratch, block, chunk, running[chunk], found);
        }
        for (int half = 0; half < kHalves; ++half) {
          const int base = chunk * kChunk + half * (kChunk / kHalves);
          merge(found[half], end - first, static_cast<std::uint32_t>(base), best);
        }
      }
      finish_block(shape, strip, scratch, first, end, best, out);
    }
  }

 private:
  // The columns [first, end), of a block that begins with column `base`.
  struct Block {
    int first, end, base;
  };

  // The window sums of a chunk on their way along the row, in memory between two blocks, register by
  // register.
  struct alignas(64) Running {
    std::uint16_t sums[kMaxChunk];
  };

  // Which register holds the `position`-th run of kLanes disparities of the chunk.
  static constexpr int register_of(int position) {
    if (!kEvenOdd) return position;
    return position < kVectors ? 2 * position : 2 * (position - kVectors) + 1;
  }

  // In packed arithmetic the low bits of every sum hold the number of its group of 8 disparities.
  static void start(Running& running) {
    for (int k = 0; k < kChunk; ++k) {
      int group = 0;
      if (kA == Arithmetic::kPacked) group = k / 8;
      if (kA == Arithmetic::kPackedHalves) group = k % (kChunk / 2) / 8;
      running.sums[register_of(k / kLanes) * kLanes + k % kLanes] =
          static_cast<std::uint16_t>(group + V::kBias);
    }
  }

  // Adds the row to the column sums of the block, slides the window along them and writes for each column the
  // least sum and where it is. kMasked: disparities that cannot be searched are kept from winning. kKeep: all
  // sums go to scratch.block_sums.
  template <bool kMasked, bool kKeep>
  static void sweep(const Shape& shape, const Strip& strip, const RowChange& row, const Scratch& scratch,
                    const Block& block, int chunk, Running& running, std::uint32_t (*found)[kBlockColumns]) {
    const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(shape.window) * kChunk;
    const Masks<V> masks(shape, chunk);
    Place<V, kA, kRecompute> place(shape, strip, row, chunk, block.first);
    std::uint16_t* sums = sums_of(shape, strip, scratch, chunk, block.first);
    std::uint16_t* kept = scratch.block_sums + chunk * kChunk;
    const int kept_step = shape.padded_disparities();
    Reg window[2 * kVectors];
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) window[i] = V::load_aligned(running.sums + i * kLanes);

    for (int column = block.first; column < block.end; ++column) {
      const Reg left = V::broadcast8(*place.left);
      const Reg removed_left = kRecompute ? V::broadcast8(*place.removed_left) : left;
      const std::uint16_t* mask = nullptr;
      if constexpr (kMasked) mask = masks.at(column);
      Reg candidates[2 * kVectors];
#pragma GCC unroll 4
      for (int c = 0; c < kVectors; ++c) {
        Reg first, second;
        std::uint16_t* const in = sums + c * V::kBytes;
        ColumnUpdate<V, kA, kRecompute>::apply(place, c * V::kBytes, left, removed_left, in, first, second);
        Reg& lower = window[2 * c];
        Reg& upper = window[2 * c + 1];
        lower = V::add16(lower, V::sub16(first, V::load_aligned(in - back)));
        upper = V::add16(upper, V::sub16(second, V::load_aligned(in - back + kLanes)));
        V::pin(lower);
        V::pin(upper);
        candidates[2 * c] = lower;
        candidates[2 * c + 1] = upper;
        if constexpr (kMasked) mask_lanes(mask, c, candidates[2 * c], candidates[2 * c + 1]);
        if constexpr (kKeep) keep(kept, c, candidates[2 * c], candidates[2 * c + 1]);
      }
      find_least(candidates, column - block.first, found);
      sums += kChunk;
      place.next_column(kChunk);
      if constexpr (kKeep) kept += kept_step;
    }
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) V::store_aligned(running.sums + i * kLanes, window[i]);
  }

  static inline void mask_lanes(const std::uint16_t* mask, int c, Reg& first, Reg& second) {
    Reg first_mask, second_mask;
    if constexpr (kEvenOdd) {
      first_mask = V::load(mask + c * kLanes);
      second_mask = V::load(mask + kChunk / 2 + c * kLanes);
    } else {
      V::load_in_order(mask + c * V::kBytes, first_mask, second_mask);
    }
    first = V::masked(first, first_mask);
    second = V::masked(second, second_mask);
  }

  static inline void keep(std::uint16_t* kept, int c, Reg first, Reg second) {
    if constexpr (kEvenOdd) {
      V::store_aligned(kept + c * kLanes, first);
      V::store_aligned(kept + kChunk / 2 + c * kLanes, second);
    } else {
      V::store_in_order(kept + c * V::kBytes, first, second);
    }
  }

  // Packed: the least sum in the low half, its lane in the high half. Else: the least sum in the low half,
  // its k in the high half.
  static inline void find_least(const Reg* sums, int at, std::uint32_t (*found)[kBlockColumns]) {
    if constexpr (kHalves == 2) {
#pragma GCC unroll 2
      for (int half = 0; half < 2; ++half) {
        Reg least = sums[register_of(half * kVectors)];
#pragma GCC unroll 4
        for (int c = 1; c < kVectors; ++c) least = V::min16(least, sums[register_of(half * kVectors + c)]);
        found[half][at] = V::least_lane(least);
      }
    } else {
      // One after the other: as a tree it would take more copies of registers.
      Reg least = sums[0];
#pragma GCC unroll 8
      for (int i = 1; i < 2 * kVectors; ++i) least = V::min16(least, sums[i]);
      std::uint32_t minimum = V::least_lane(least);
      if constexpr (kA != Arithmetic::kPacked) {
        const Reg wanted = V::broadcast16(static_cast<std::uint16_t>(minimum ^ V::kBias));
        minimum = (minimum & 0xFFFF) | V::template first_equal<kVectors, kEvenOdd>(sums, wanted) << 16;
      }
      found[0][at] = minimum;
    }
  }

  // Brings found[] of disparities from `base` on to cost << 16 | k and keeps the lesser of it and best[].
  static inline void merge(const std::uint32_t* found, int count, std::uint32_t base, std::uint32_t* best) {
    constexpr int kShift = shift_of(kA);
    constexpr std::uint32_t kGroups = (1U << kShift) - 1;
    for (int i = 0; i < count; ++i) {
      const std::uint32_t value = found[i];
      const std::uint32_t cost = (value & 0xFFFF) >> kShift;
      const std::uint32_t entry = cost << 16 | (((value & kGroups) << 3) + (value >> 16) + base);
      best[i] = base > 0 && best[i] <= entry ? best[i] : entry;
    }
  }

  // Writes the winners of the block's columns whose window is complete.
  static void finish_block(const Shape& shape, const Strip& strip, const Scratch& scratch, int first, int end,
                           const std::uint32_t* best, const Winners& out) {
    const int skip = shape.window - 1;  // columns before the first complete window
    const int begin = first > strip.first + skip ? first : strip.first + skip;
    for (int column = begin; column < end; ++column) {
      out.index[column - skip] = static_cast<std::uint16_t>(best[column - first]);
      out.cost[column - skip] = best[column - first] >> 16;
    }
    const Block block{begin, end, first};
    if (shape.neighbours) write_neighbours(shape, scratch, block, best, out);
    if (shape.uniqueness_ratio > 0) write_ambiguous(shape, scratch, block, best, out);
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
    std::uint8_t* out_ambiguous = out.ambiguous + block.base - (shape.window - 1);
    for (int i = 0; i < block.end - block.base; ++i) {
      const Reg limit = V::broadcast16(static_cast<std::uint16_t>(limits[i] ^ V::kBias));
      const int winner = static_cast<int>(best[i] & 0xFFFF);
      std::uint64_t rivals = 0;
      for (int chunk = 0; chunk < chunks; ++chunk, sums += kChunk) {
        rivals |= V::template at_most<kVectors>(sums, limit) & ~beside(winner - chunk * kChunk);
      }
      if (i >= block.first - block.base) out_ambiguous[i] = rivals != 0 ? 1 : 0;
    }
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
