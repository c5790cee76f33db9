// The one source of the block-matching kernels. Each kernel_<isa>.cpp compiles it for its instruction set.
//
// Method: for every column c and disparity k the sum of |L−R| over the window's rows is kept in memory as a
// 16-bit column sum. A new row changes it by the difference that comes in less the one that leaves. Along the
// row the window's sums of all disparities of a chunk stay in registers: the column sum that comes in is
// added, the one `window` columns back subtracted. Disparities are the lanes, so the winner is a minimum over
// lanes.
//
// This header is compiled with instructions that the running CPU may lack. Nothing in it may come from a
// header whose inline functions other files use too (the linker keeps one copy of those): no std:: functions.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/interpolation.h"
#include "core/match/kernels/kernel.h"

namespace stereod::kernels {

/// V is the vector layer: V::Reg, V::kBytes and the operations of vector_scalar.h.
template <typename V>
class BlockKernel {
  using Reg = typename V::Reg;
  static constexpr int kLanes = V::kBytes / 2;

 public:
  static constexpr int kGranularity = V::kBytes;

  static void prepare_right_row(const Shape& shape, const std::uint8_t* right, std::uint8_t* out) {
    const int length = shape.width + shape.padded_disparities();
    const bool interleaved = shape.arithmetic != Arithmetic::kWide;
    // Backwards first, into the upper half of the memory if more is to come: interleaving from there to the
    // front never writes what is still to be read.
    std::uint8_t* backwards = interleaved ? out + length : out;
    int p = 0;
    for (; p + 16 <= shape.width; p += 16) V::reverse16(right + shape.width - 16 - p, backwards + p);
    for (; p < shape.width; ++p) backwards[p] = right[shape.width - 1 - p];
    for (; p < length; ++p) backwards[p] = 0;
    if (interleaved) interleave(backwards, shape.chunk / 2, length, out);
  }

  static void add_row(const Shape& shape, const AddedRow& row, const Scratch& scratch) {
    switch (shape.arithmetic) {
      case Arithmetic::kPacked:
        return add_chunks<Arithmetic::kPacked>(shape, row, scratch);
      case Arithmetic::kNarrow:
        return add_chunks<Arithmetic::kNarrow>(shape, row, scratch);
      case Arithmetic::kRaw:
        return add_chunks<Arithmetic::kRaw>(shape, row, scratch);
      case Arithmetic::kWide:
        return wide_row<false>(shape, row, scratch, {});
    }
  }

  static void search_row(const Shape& shape, const AddedRow& row, const Scratch& scratch,
                         const Winners& winners) {
    switch (shape.arithmetic) {
      case Arithmetic::kPacked:
        return search_by_size<Arithmetic::kPacked>(shape, row, scratch, winners);
      case Arithmetic::kNarrow:
        return search_by_size<Arithmetic::kNarrow>(shape, row, scratch, winners);
      case Arithmetic::kRaw:
        return search_by_size<Arithmetic::kRaw>(shape, row, scratch, winners);
      case Arithmetic::kWide:
        return wide_row<true>(shape, row, scratch, winners);
    }
  }

 private:
  // out[2p] = in[p], out[2p + 1] = in[p + half] for p < length, 0 where that lies beyond; in may be out +
  // length.
  static void interleave(const std::uint8_t* in, int half, int length, std::uint8_t* out) {
    int p = 0;
    for (; p + 16 <= length - half; p += 16) V::interleave16(in + p, in + half + p, out + 2 * p);
    for (; p < length; ++p) {
      const std::uint8_t lower = in[p];
      const std::uint8_t upper = p + half < length ? in[p + half] : std::uint8_t{0};
      out[2 * p] = lower;
      out[2 * p + 1] = upper;
    }
  }

  // --- column sums -----------------------------------------------------------------------------------------

  struct Change {
    Reg even, odd;  // of the lower and of the upper half of the chunk
  };

  // By how much 2·kLanes column sums change: |L−R| of the row added less that of the row removed, whose place
  // the new one takes.
  template <Arithmetic kA>
  static inline Change column_change(Reg left, const std::uint8_t* right, std::uint8_t* differences) {
    const Reg added = V::abs_diff_u8(left, V::load_once(right));
    const Reg removed = V::load_aligned(differences);
    V::store(differences, added);
    if constexpr (kA == Arithmetic::kRaw) {
      return {V::sub16(V::even_u8(added), V::even_u8(removed)),
              V::sub16(V::odd_u8(added), V::odd_u8(removed))};
    } else {
      constexpr int kShift = kA == Arithmetic::kPacked ? 3 : 0;
      const Reg change = V::sub8(added, removed);  // fits in a signed byte since |L−R| ≤ 126
      return {V::template even_s8<kShift>(change), V::template odd_s8<kShift>(change)};
    }
  }

  // Where the right row's bytes for column c, disparity `first` of a chunk begin.
  static inline std::ptrdiff_t right_offset(const Shape& shape, int column, int first) {
    return 2 * (static_cast<std::ptrdiff_t>(shape.width) - 1 - column + first);
  }

  static inline std::uint16_t* chunk_sums(const Shape& shape, const Scratch& scratch, int chunk) {
    const std::ptrdiff_t columns = shape.window + shape.columns();
    return scratch.column_sums + (chunk * columns + shape.window) * shape.chunk;
  }

  static inline std::uint8_t* chunk_differences(const Shape& shape, const AddedRow& row, int chunk) {
    return row.differences + static_cast<std::ptrdiff_t>(chunk) * shape.columns() * shape.chunk;
  }

  template <Arithmetic kA>
  static void add_chunks(const Shape& shape, const AddedRow& row, const Scratch& scratch) {
    for (int chunk = 0; chunk < shape.chunks; ++chunk) {
      std::uint16_t* sums = chunk_sums(shape, scratch, chunk);
      std::uint8_t* differences = chunk_differences(shape, row, chunk);
      for (int column = 0; column < shape.columns();
           ++column, sums += shape.chunk, differences += shape.chunk) {
        const Reg left = V::broadcast8(row.left[column]);
        const std::uint8_t* right = row.right + right_offset(shape, column, chunk * shape.chunk);
        for (int c = 0; c < shape.chunk; c += V::kBytes) {
          const Change change = column_change<kA>(left, right + c, differences + c);
          V::store(sums + c, V::add16(V::load_aligned(sums + c), change.even));
          V::store(sums + c + kLanes, V::add16(V::load_aligned(sums + c + kLanes), change.odd));
        }
      }
    }
  }

  // --- search ----------------------------------------------------------------------------------------------

  template <Arithmetic kA>
  static void search_by_size(const Shape& shape, const AddedRow& row, const Scratch& scratch,
                             const Winners& out) {
    switch (shape.chunk / V::kBytes) {
      case 1:
        return search_blocks<kA, 1>(shape, row, scratch, out);
      case 2:
        return search_blocks<kA, 2>(shape, row, scratch, out);
      case 3:
        if constexpr (3 * V::kBytes <= kMaxChunk) return search_blocks<kA, 3>(shape, row, scratch, out);
        break;
      case 4:
        if constexpr (4 * V::kBytes <= kMaxChunk) return search_blocks<kA, 4>(shape, row, scratch, out);
        break;
      default:
        break;
    }
  }

  // The window sums of a chunk on their way along the row, in memory between two blocks. Order: register by
  // register, the lower half's and the upper half's alternating.
  struct alignas(64) Running {
    std::uint16_t sums[kMaxChunk];
  };

  template <Arithmetic kA, int kVectors>
  static void search_blocks(const Shape& shape, const AddedRow& row, const Scratch& scratch,
                            const Winners& out) {
    Running running[kMaxChunks];
    for (int chunk = 0; chunk < shape.chunks; ++chunk) start_running<kA, kVectors>(running[chunk]);
    const bool keep_sums = shape.neighbours || shape.rival;
    for (int first = 0; first < shape.columns(); first += kBlockColumns) {
      const int end = first + kBlockColumns < shape.columns() ? first + kBlockColumns : shape.columns();
      std::uint32_t best[kBlockColumns];  // cost << 16 | k: the least is the winner, the lowest k on a tie
      for (int chunk = 0; chunk < shape.chunks; ++chunk) {
        std::uint32_t found[kBlockColumns];
        // All disparities of the chunk can be searched in every column of the block, or some lanes are
        // masked.
        const int chunk_end = (chunk + 1) * shape.chunk;
        const bool masked = chunk_end > shape.disparities || first - shape.window + 2 < chunk_end;
        if (keep_sums) {
          masked
              ? sweep<kA, kVectors, true, true>(shape, row, scratch, chunk, first, end, running[chunk], found)
              : sweep<kA, kVectors, false, true>(shape, row, scratch, chunk, first, end, running[chunk],
                                                 found);
        } else {
          masked ? sweep<kA, kVectors, true, false>(shape, row, scratch, chunk, first, end, running[chunk],
                                                    found)
                 : sweep<kA, kVectors, false, false>(shape, row, scratch, chunk, first, end, running[chunk],
                                                     found);
        }
        merge<kA>(found, end - first, chunk, shape.chunk, best);
      }
      finish_block<kA>(shape, scratch, first, end, best, out);
    }
  }

  // In packed arithmetic the low three bits of every sum hold the number of its group of 8 disparities.
  template <Arithmetic kA, int kVectors>
  static void start_running(Running& running) {
    constexpr int kHalf = kVectors * kLanes;
    for (int c = 0; c < kVectors; ++c) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const int k = c * kLanes + lane;
        running.sums[2 * c * kLanes + lane] =
            static_cast<std::uint16_t>(kA == Arithmetic::kPacked ? k / 8 : 0);
        running.sums[(2 * c + 1) * kLanes + lane] =
            static_cast<std::uint16_t>(kA == Arithmetic::kPacked ? (kHalf + k) / 8 : 0);
      }
    }
  }

  // Adds the row to the column sums of [first, end), slides the window along them and writes for each column
  // the least sum and where it is. kMasked: disparities that cannot be searched are kept from winning. kKeep:
  // all sums go to scratch.block_sums.
  template <Arithmetic kA, int kVectors, bool kMasked, bool kKeep>
  static void sweep(const Shape& shape, const AddedRow& row, const Scratch& scratch, int chunk, int first,
                    int end, Running& running, std::uint32_t* found) {
    constexpr int kChunk = kVectors * V::kBytes;
    const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(shape.window) * kChunk;
    std::uint16_t* sums = chunk_sums(shape, scratch, chunk) + static_cast<std::ptrdiff_t>(first) * kChunk;
    std::uint16_t* kept = scratch.block_sums + chunk * kChunk;
    const std::uint8_t* left = row.left;
    const std::uint8_t* right = row.right + right_offset(shape, first, chunk * kChunk);
    std::uint8_t* differences =
        chunk_differences(shape, row, chunk) + static_cast<std::ptrdiff_t>(first) * kChunk;
    Reg window[2 * kVectors];
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) window[i] = V::load_aligned(running.sums + i * kLanes);

    for (int column = first; column < end; ++column) {
      const Reg left_pixel = V::broadcast8(left[column]);
      const std::uint16_t* mask = nullptr;
      if constexpr (kMasked) mask = mask_for(shape, column, chunk * kChunk, kChunk);
      Reg candidates[2 * kVectors];
#pragma GCC unroll 4
      for (int c = 0; c < kVectors; ++c) {
        const Change change =
            column_change<kA>(left_pixel, right + c * V::kBytes, differences + c * V::kBytes);
        std::uint16_t* even = sums + 2 * c * kLanes;
        std::uint16_t* odd = even + kLanes;
        const Reg sum_even = V::add16(V::load_aligned(even), change.even);
        const Reg sum_odd = V::add16(V::load_aligned(odd), change.odd);
        V::store(even, sum_even);
        V::store(odd, sum_odd);
        window[2 * c] = V::sub16(V::add16(window[2 * c], sum_even), V::load_aligned(even - back));
        window[2 * c + 1] = V::sub16(V::add16(window[2 * c + 1], sum_odd), V::load_aligned(odd - back));
        candidates[2 * c] = window[2 * c];
        candidates[2 * c + 1] = window[2 * c + 1];
        if constexpr (kMasked) {
          candidates[2 * c] = V::bit_or(candidates[2 * c], V::load(mask + c * kLanes));
          candidates[2 * c + 1] = V::bit_or(candidates[2 * c + 1], V::load(mask + kChunk / 2 + c * kLanes));
        }
        if constexpr (kKeep) {
          V::store(kept + c * kLanes, candidates[2 * c]);
          V::store(kept + kChunk / 2 + c * kLanes, candidates[2 * c + 1]);
        }
      }
      found[column - first] = least<kA, kVectors>(candidates);
      sums += kChunk;
      right -= 2;
      differences += kChunk;
      if constexpr (kKeep) kept += shape.padded_disparities();
    }
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) V::store(running.sums + i * kLanes, window[i]);
  }

  // 16-bit lanes of all ones for the disparities of a chunk that begins with `base` which cannot be searched.
  static inline const std::uint16_t* mask_for(const Shape& shape, int column, int base, int chunk) {
    alignas(64) static constexpr auto kMask = [] {
      struct {
        std::uint16_t lanes[2 * kMaxChunk];
      } mask{};
      for (int i = kMaxChunk; i < 2 * kMaxChunk; ++i) mask.lanes[i] = 0xFFFF;
      return mask;
    }();
    int searched = column - shape.window + 2;
    if (searched > shape.disparities) searched = shape.disparities;
    searched -= base;
    if (searched < 0) searched = 0;
    if (searched > chunk) searched = chunk;
    return kMask.lanes + kMaxChunk - searched;
  }

  // Packed: the least sum in the low half, its lane in the high half. Else: the least sum in the low half,
  // its k in the high half.
  template <Arithmetic kA, int kVectors>
  static inline std::uint32_t least(const Reg* sums) {
    Reg least = V::min_u16(sums[0], sums[1]);
#pragma GCC unroll 4
    for (int c = 1; c < kVectors; ++c) least = V::min_u16(least, V::min_u16(sums[2 * c], sums[2 * c + 1]));
    const std::uint32_t minimum = V::least_lane(least);
    if constexpr (kA == Arithmetic::kPacked) {
      return minimum;
    } else {
      const Reg wanted = V::broadcast16(static_cast<std::uint16_t>(minimum));
      return (minimum & 0xFFFF) | V::template first_equal<kVectors>(sums, wanted) << 16;
    }
  }

  // Brings found[] of one chunk to cost << 16 | k and keeps the lesser of it and best[].
  template <Arithmetic kA>
  static inline void merge(const std::uint32_t* found, int count, int chunk, int chunk_size,
                           std::uint32_t* best) {
    const auto base = static_cast<std::uint32_t>(chunk * chunk_size);
    for (int i = 0; i < count; ++i) {
      const std::uint32_t value = found[i];
      std::uint32_t entry;
      if constexpr (kA == Arithmetic::kPacked) {
        entry = (value & 0xFFF8) << 13 | ((value & 7) << 3 | value >> 16);
      } else {
        entry = value << 16 | value >> 16;
      }
      entry += base;
      best[i] = chunk > 0 && best[i] <= entry ? best[i] : entry;
    }
  }

  // Writes the winners of the block's columns whose window is complete.
  template <Arithmetic kA>
  static void finish_block(const Shape& shape, const Scratch& scratch, int first, int end,
                           const std::uint32_t* best, const Winners& out) {
    constexpr int kShift = kA == Arithmetic::kPacked ? 3 : 0;
    const int skip = shape.window - 1;  // columns before the first complete window
    const int begin = first > skip ? first : skip;
    for (int column = begin; column < end; ++column) {
      out.index[column - skip] = static_cast<std::uint16_t>(best[column - first]);
      out.cost[column - skip] = best[column - first] >> 16;
    }
    const int stride = shape.padded_disparities();
    if (shape.neighbours) {
      for (int column = begin; column < end; ++column) {
        const std::uint16_t* sums =
            scratch.block_sums + (column - first) * stride + (best[column - first] & 0xFFFF);
        out.before[column - skip] = static_cast<std::uint32_t>(sums[-1] >> kShift);
        out.after[column - skip] = static_cast<std::uint32_t>(sums[1] >> kShift);
      }
    }
    if (!shape.rival) return;
    for (int column = begin; column < end; ++column) {  // the winner and its neighbours do not rival it
      std::uint16_t* sums = scratch.block_sums + (column - first) * stride;
      const int k = static_cast<int>(best[column - first] & 0xFFFF);
      if (k > 0) sums[k - 1] = 0xFFFF;
      sums[k] = 0xFFFF;
      if (k + 1 < stride) sums[k + 1] = 0xFFFF;
    }
    for (int column = begin; column < end; ++column) {
      const std::uint16_t* sums = scratch.block_sums + (column - first) * stride;
      Reg least = V::load(sums);
      for (int k = kLanes; k < stride; k += kLanes) least = V::min_u16(least, V::load(sums + k));
      const std::uint32_t cost = V::least_lane(least) & 0xFFFF;
      out.rival[column - skip] = cost == 0xFFFF ? 0xFFFFFFFFu : cost >> kShift;
    }
  }

  // --- windows that overflow 16 bits
  // -------------------------------------------------------------------------

  // The same method with 32-bit sums in plain loops over the disparities, which the compiler vectorises.
  template <bool kSearch>
  static void wide_row(const Shape& shape, const AddedRow& row, const Scratch& scratch, const Winners& out) {
    std::uint32_t window[kMaxChunk * kMaxChunks] = {};
    const int padded = shape.padded_disparities();
    const std::ptrdiff_t back = static_cast<std::ptrdiff_t>(shape.window) * padded;
    std::uint16_t* sums = chunk_sums(shape, scratch, 0);
    std::uint8_t* differences = row.differences;
    for (int column = 0; column < shape.columns(); ++column, sums += padded, differences += padded) {
      const int left = row.left[column];
      const std::uint8_t* right = row.right + (shape.width - 1 - column);
      for (int k = 0; k < padded; ++k) {
        const int added = left > right[k] ? left - right[k] : right[k] - left;
        sums[k] = static_cast<std::uint16_t>(sums[k] + added - differences[k]);
        differences[k] = static_cast<std::uint8_t>(added);
      }
      if constexpr (kSearch) {
        for (int k = 0; k < padded; ++k) window[k] += static_cast<std::uint32_t>(sums[k]) - sums[k - back];
        const int at = column - shape.window + 1;
        if (at >= 0)
          wide_winner(window, at + 1 < shape.disparities ? at + 1 : shape.disparities, at, shape, out);
      }
    }
  }

  static void wide_winner(const std::uint32_t* costs, int searched, int at, const Shape& shape,
                          const Winners& out) {
    std::uint32_t least = costs[0];
    for (int k = 1; k < searched; ++k) least = costs[k] < least ? costs[k] : least;
    int best = 0;
    while (costs[best] != least) ++best;
    out.index[at] = static_cast<std::uint16_t>(best);
    out.cost[at] = least;
    if (shape.neighbours) {
      out.before[at] = best > 0 ? costs[best - 1] : 0;
      out.after[at] = best + 1 < searched ? costs[best + 1] : 0;
    }
    if (shape.rival) {
      std::uint32_t rival = 0xFFFFFFFFu;
      for (int k = 0; k < best - 1; ++k) rival = costs[k] < rival ? costs[k] : rival;
      for (int k = best + 2; k < searched; ++k) rival = costs[k] < rival ? costs[k] : rival;
      out.rival[at] = rival;
    }
  }
};

/// The table entry of an instruction set.
template <typename V>
constexpr Kernel make_kernel() {
  return {BlockKernel<V>::kGranularity, BlockKernel<V>::prepare_right_row, BlockKernel<V>::add_row,
          BlockKernel<V>::search_row, interpolate<float, V>};
}

}  // namespace stereod::kernels
