// The search: along the row the window's sums of all disparities of a chunk stay in registers: the column sum
// that comes in is added, the one `window` columns back subtracted. Disparities are the lanes, so the winner
// is a minimum over lanes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/block/kernels/block_winners.h"
#include "core/match/block/kernels/column_sums.h"
#include "core/match/block/kernels/kernel.h"

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
      : before_first(shape.window - 2 + shape.first_of(chunk)),
        most(shape.disparities < shape.chunk ? shape.disparities : shape.chunk) {}

  inline const std::uint16_t* at(int column) const {
    int searched = column - before_first;
    searched = searched < most ? searched : most;
    searched = searched > 0 ? searched : 0;
    return kLanes.lanes + kMaxChunk - searched;
  }

  int before_first;  // the column before the first one in which a disparity of the chunk can be searched
  int most;          // disparities of the chunk that are searched
};

template <typename V, Arithmetic kA, int kVectors>
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
    Best best;
    std::uint32_t found[kHalves][kBlockColumns] = {};
    for (int first = strip.first, end = first; first < strip.end; first = end) {
      end = end_of_block(shape, strip, first);
      for (int chunk = 0; chunk < shape.chunks; ++chunk) {
        const Block block{first, end};
        const Sweep sweep_block = sweep_for(shape, block, chunk);
        sweep_block(shape, strip, change, scratch, block, chunk, running[chunk], found);
        for (int half = 0; half < kHalves && first != strip.first; ++half) {
          BlockWinners<V, kA>::merge(found[half], places_of(shape, chunk, half), chunk == 0 && half == 0,
                                     best);
        }
      }
      if (first != strip.first) WinnerWriter<V>::write(shape, scratch, {first, end}, best, out);
    }
  }

 private:
  // The first block of a strip is what comes before the first whole window. Another ends where the left
  // border does if that keeps some columns from being searched as those of the border are.
  static int end_of_block(const Shape& shape, const Strip& strip, int first) {
    if (first == strip.first) return first + shape.window - 1;
    constexpr int kSome = 8;
    const int border_end = shape.disparities + shape.window - 2;
    int end = first + kBlockColumns;
    if (first < border_end && border_end + kSome < end) end = border_end;
    return end < strip.end ? end : strip.end;
  }

  // Which disparities the places in a chunk, or in half of one, are.
  static Places places_of(const Shape& shape, int chunk, int half) {
    const int begin = half * (kChunk / kHalves);
    const int last = last_part<V>(kA, kChunk);
    return {static_cast<std::int16_t>(shape.first_of(chunk) + begin), static_cast<std::int16_t>(last - begin),
            static_cast<std::int16_t>(last - last_part_disparity<V>(shape))};
  }

  struct Running;
  using Sweep = void (*)(const Shape&, const Strip&, const RowChange&, const Scratch&, const Block&,
                         int chunk, Running&, std::uint32_t (*found)[kBlockColumns]);

  // At the left border less disparities can be searched than elsewhere. Plain C++ has one function for all
  // cases: compiled to be small it is no slower than several, and else by a tenth at most.
  static Sweep sweep_for(const Shape& shape, const Block& block, int chunk) {
    return shape.recompute ? sweep_for<true>(shape, block, chunk) : sweep_for<false>(shape, block, chunk);
  }
  template <bool kRecompute>
  static Sweep sweep_for(const Shape& shape, const Block& block, int chunk) {
    if constexpr (requires { V::kOneSize; }) return sweep<kRecompute, true, kShifted>;
    const bool keep = shape.neighbors || shape.uniqueness_ratio > 0;
    const int back = last_part<V>(kA, kChunk) - last_part_disparity<V>(shape);
    const int lanes_end = shape.first_of(chunk) + kChunk - back;
    if (block.first - shape.window + 2 < lanes_end || lanes_end > shape.disparities) {
      return keep ? sweep<kRecompute, true, kShifted> : sweep<kRecompute, true, kNothing>;
    }
    if (!keep) return sweep<kRecompute, false, kNothing>;
    const bool aligned = back == 0 && shape.first_of(chunk) % kLanes == 0;
    return aligned ? sweep<kRecompute, false, kAligned> : sweep<kRecompute, false, kShifted>;
  }

  // What goes to scratch.block_sums: nothing, or all sums, in whole vectors one after the other or wherever
  // the chunk's first disparity and its last part make them lie.
  enum Keep { kNothing, kAligned, kShifted };

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

  // In packed arithmetic the low bits of every sum hold the number of its group of 8 places.
  static void start(Running& running) {
    Running ordered;
    for (int place = 0; place < kChunk; ++place) {
      int sum = 0;
      if (kA == Arithmetic::kPacked) sum = place / 8;
      if (kA == Arithmetic::kPackedHalves) sum = place % (kChunk / 2) / 8;
      ordered.sums[place] = static_cast<std::uint16_t>(sum + V::kBias);
    }
    for (int c = 0; c < kVectors; ++c) {
      Reg first, second;
      load_lanes(ordered.sums, c, last_part<V>(kA, kChunk), first, second);
      V::store_aligned(running.sums + 2 * c * kLanes, first);
      V::store_aligned(running.sums + (2 * c + 1) * kLanes, second);
    }
  }

  // Adds the row to the column sums of the block, slides the window along them and writes for each column the
  // least sum and where it is. kRamp: which disparities can be searched differs from column to column.
  template <bool kRecompute, bool kRamp, Keep kKeep>
  static void sweep(const Shape& shape, const Strip& strip, const RowChange& row, const Scratch& scratch,
                    const Block& block, int chunk, Running& running, std::uint32_t (*found)[kBlockColumns]) {
    const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(shape.window) * kChunk;
    const Masks<V> masks(shape, chunk);
    const std::uint16_t* mask = nullptr;
    const int last = kKeep == kAligned ? last_part<V>(kA, kChunk) : last_part_disparity<V>(shape);
    Place<V, kA, kRecompute> place(shape, strip, row, chunk, block.first);
    std::uint16_t* sums = sums_of(shape, strip, scratch, chunk, block.first);
    std::uint16_t* kept = scratch.block_sums + shape.first_of(chunk);
    const int kept_step = shape.block_step();
    Reg window[2 * kVectors];
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) window[i] = V::load_aligned(running.sums + i * kLanes);

    for (int column = block.first; column < block.end; ++column) {
      const Reg left = V::broadcast8(*place.left);
      const Reg removed_left = kRecompute ? V::broadcast8(*place.removed_left) : left;
      if constexpr (kRamp) mask = masks.at(column);
      Reg candidates[2 * kVectors];
#pragma GCC unroll 4
      for (int c = 0; c < kVectors; ++c) {
        Reg first, second;
        std::uint16_t* const in = sums + c * V::kBytes;
        ColumnUpdate<V, kA, kRecompute>::apply(place, c * V::kBytes, c == kVectors - 1, last, left,
                                               removed_left, in, first, second);
        Reg& lower = window[2 * c];
        Reg& upper = window[2 * c + 1];
        // Pinned so that the compiler does not take the old sum from the window's instead: with its sum of
        // three it would need a copy.
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
        if constexpr (kRamp) mask_lanes(mask, c, last, candidates[2 * c], candidates[2 * c + 1]);
        if constexpr (kKeep != kNothing) {
          keep<kKeep>(kept, c, last, candidates[2 * c], candidates[2 * c + 1]);
        }
      }
      find_least(candidates, column - block.first, found);
      sums += kChunk;
      place.next_column(kChunk);
      if constexpr (kKeep != kNothing) kept += kept_step;
    }
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) V::store_aligned(running.sums + i * kLanes, window[i]);
  }

  // From numbers in the order of disparities to the registers of byte vector c; the chunk's last part begins
  // with number `last`.
  [[gnu::always_inline]] static inline void load_lanes(const std::uint16_t* ordered, int c, int last,
                                                       Reg& first, Reg& second) {
    if constexpr (kEvenOdd) {
      first = V::load(ordered + c * kLanes);
      second = V::load(ordered + last + c * kLanes);
    } else {
      V::load_in_order(ordered + begin_of(c, last), first, second);
    }
  }

  [[gnu::always_inline]] static inline void mask_lanes(const std::uint16_t* mask, int c, int last, Reg& first,
                                                       Reg& second) {
    Reg first_mask, second_mask;
    load_lanes(mask, c, last, first_mask, second_mask);
    first = V::masked(first, first_mask);
    second = V::masked(second, second_mask);
  }

  template <Keep kKeep>
  [[gnu::always_inline]] static inline void keep(std::uint16_t* kept, int c, int last, Reg first,
                                                 Reg second) {
    if constexpr (!kEvenOdd) {
      V::template store_in_order<kKeep == kAligned>(kept + begin_of(c, last), first, second);
    } else if constexpr (kKeep == kAligned) {
      V::store_aligned(kept + c * kLanes, first);
      V::store_aligned(kept + last + c * kLanes, second);
    } else {
      V::store(kept + c * kLanes, first);
      V::store(kept + last + c * kLanes, second);
    }
  }

  // The first disparity of byte vector c where vectors follow one another.
  [[gnu::always_inline]] static inline int begin_of(int c, int last) {
    return c == kVectors - 1 ? last : c * V::kBytes;
  }

  // Packed: the least sum in the low half, its lane in the high half. Else: the least sum in the low half,
  // its place in the chunk in the high half.
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
};

}  // namespace stereod::kernels
