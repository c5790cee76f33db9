// The search: along the row the window's sums of all disparities of a chunk stay in registers: the column sum
// that comes in is added, the one `window` columns back subtracted. Disparities are the lanes, so the winner is
// a minimum over lanes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/kernels/column_sums.h"
#include "core/match/kernels/kernel.h"

namespace stereod::kernels {

/// 16-bit lanes of all ones (plus bias) for the disparities of a chunk beginning with `base` that cannot be
/// searched.
template <typename V>
inline const std::uint16_t* mask_for(const Shape& shape, int column, int base, int chunk) {
  alignas(64) static constexpr auto kMask = [] {
    struct {
      std::uint16_t lanes[2 * kMaxChunk];
    } mask{};
    for (int i = 0; i < kMaxChunk; ++i) mask.lanes[i] = V::kBias;
    for (int i = kMaxChunk; i < 2 * kMaxChunk; ++i) mask.lanes[i] = 0xFFFF ^ V::kBias;
    return mask;
  }();
  int searched = column - shape.window + 2;
  if (searched > shape.disparities) searched = shape.disparities;
  searched -= base;
  if (searched < 0) searched = 0;
  if (searched > chunk) searched = chunk;
  return kMask.lanes + kMaxChunk - searched;
}

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
    const bool keep_sums = shape.neighbours || shape.rival;
    for (int first = strip.first; first < strip.end; first += kBlockColumns) {
      const int end = first + kBlockColumns < strip.end ? first + kBlockColumns : strip.end;
      std::uint32_t best[kBlockColumns];  // cost << 16 | k: the least is the winner, the lowest k on a tie
      for (int chunk = 0; chunk < shape.chunks; ++chunk) {
        const Block block{first, end, chunk};
        // All disparities of the chunk can be searched in every column of the block, or some lanes are
        // masked.
        const int chunk_end = (chunk + 1) * kChunk;
        const bool masked = chunk_end > shape.disparities || first - shape.window + 2 < chunk_end;
        std::uint32_t found[kHalves][kBlockColumns];
        if (keep_sums) {
          masked ? sweep<true, true>(shape, strip, change, scratch, block, running[chunk], found)
                 : sweep<false, true>(shape, strip, change, scratch, block, running[chunk], found);
        } else {
          masked ? sweep<true, false>(shape, strip, change, scratch, block, running[chunk], found)
                 : sweep<false, false>(shape, strip, change, scratch, block, running[chunk], found);
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
  struct Block {
    int first, end;  // columns
    int chunk;
  };

  // The window sums of a chunk on their way along the row, in memory between two blocks, register by register.
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
      running.sums[register_of(k / kLanes) * kLanes + k % kLanes] = static_cast<std::uint16_t>(group + V::kBias);
    }
  }

  // Adds the row to the column sums of the block, slides the window along them and writes for each column the
  // least sum and where it is. kMasked: disparities that cannot be searched are kept from winning. kKeep: all
  // sums go to scratch.block_sums.
  template <bool kMasked, bool kKeep>
  static void sweep(const Shape& shape, const Strip& strip, const RowChange& row, const Scratch& scratch,
                    const Block& block, Running& running, std::uint32_t (*found)[kBlockColumns]) {
    const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(shape.window) * kChunk;
    const int base = block.chunk * kChunk;
    const std::ptrdiff_t at = right_offset<V, kA>(shape, block.first, base);
    const std::uint8_t* right = row.added.right + at;
    const std::uint8_t* removed_right = kRecompute ? row.removed.right + at : nullptr;
    std::uint16_t* sums = sums_of(shape, strip, scratch, block.chunk, block.first);
    std::uint16_t* kept = scratch.block_sums + base;
    std::uint8_t* differences =
        kRecompute ? nullptr : differences_of(shape, strip, row, block.chunk, block.first);
    Reg window[2 * kVectors];
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) window[i] = V::load_aligned(running.sums + i * kLanes);

    for (int column = block.first; column < block.end; ++column) {
      const Reg left = V::broadcast8(row.added.left[column]);
      const Reg removed_left = kRecompute ? V::broadcast8(row.removed.left[column]) : left;
      const std::uint16_t* mask = nullptr;
      if constexpr (kMasked) mask = mask_for<V>(shape, column, base, kChunk);
      Reg candidates[2 * kVectors];
#pragma GCC unroll 4
      for (int c = 0; c < kVectors; ++c) {
        Reg first, second;
        std::uint16_t* const in = sums + c * V::kBytes;
        ColumnUpdate<V, kA, kRecompute>::apply(left, right + c * V::kBytes, removed_left,
                                               removed_right + c * V::kBytes, differences + c * V::kBytes, in,
                                               first, second);
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
      right -= right_step<V>(kA);
      if constexpr (kRecompute) removed_right -= right_step<V>(kA);
      if constexpr (!kRecompute) differences += kChunk;
      if constexpr (kKeep) kept += shape.padded_disparities();
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

  // Packed: the least sum in the low half, its lane in the high half. Else: the least sum in the low half, its
  // k in the high half.
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
      Reg least = V::min16(sums[0], sums[1]);
#pragma GCC unroll 4
      for (int c = 1; c < kVectors; ++c) least = V::min16(least, V::min16(sums[2 * c], sums[2 * c + 1]));
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
    if (shape.neighbours) write_neighbours(shape, scratch, begin, end, first, best, out);
    if (shape.rival) write_rivals(shape, scratch, begin, end, first, best, out);
  }

  static inline std::uint32_t cost_of(std::uint16_t sum) {
    return static_cast<std::uint32_t>((sum ^ V::kBias) >> shift_of(kA));
  }

  static void write_neighbours(const Shape& shape, const Scratch& scratch, int begin, int end, int first,
                               const std::uint32_t* best, const Winners& out) {
    const int stride = shape.padded_disparities();
    const int skip = shape.window - 1;
    for (int column = begin; column < end; ++column) {
      const std::uint16_t* sums =
          scratch.block_sums + (column - first) * stride + (best[column - first] & 0xFFFF);
      out.before[column - skip] = cost_of(sums[-1]);
      out.after[column - skip] = cost_of(sums[1]);
    }
  }

  // Destroys the kept sums of the winner and its neighbours, which do not rival it.
  static void write_rivals(const Shape& shape, const Scratch& scratch, int begin, int end, int first,
                           const std::uint32_t* best, const Winners& out) {
    constexpr std::uint16_t kNone = 0xFFFF ^ V::kBias;
    const int stride = shape.padded_disparities();
    for (int column = begin; column < end; ++column) {
      std::uint16_t* sums = scratch.block_sums + (column - first) * stride;
      const int k = static_cast<int>(best[column - first] & 0xFFFF);
      if (k > 0) sums[k - 1] = kNone;
      sums[k] = kNone;
      if (k + 1 < stride) sums[k + 1] = kNone;
    }
    for (int column = begin; column < end; ++column) {
      const std::uint16_t* sums = scratch.block_sums + (column - first) * stride;
      Reg least = V::load_aligned(sums);
      for (int k = kLanes; k < stride; k += kLanes) least = V::min16(least, V::load_aligned(sums + k));
      const std::uint32_t sum = V::least_lane(least) & 0xFFFF;
      out.rival[column - (shape.window - 1)] = sum == 0xFFFF ? 0xFFFFFFFFu : sum >> shift_of(kA);
    }
  }
};

}  // namespace stereod::kernels
