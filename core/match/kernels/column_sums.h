// Column sums: for every column c and disparity k the sum of |L−R| over the window's rows, kept in memory as
// 16 bits. A new row changes them by the differences that come in less those that leave.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/kernels/kernel.h"

namespace stereod::kernels {

/// Costs are multiplied by this power of two, to make room for the number of a group.
[[gnu::always_inline]] constexpr int shift_of(Arithmetic arithmetic) {
  return arithmetic == Arithmetic::kPacked ? 3 : arithmetic == Arithmetic::kPackedHalves ? 2 : 0;
}

/// Whether the registers of a chunk hold its lower and its upper half by turns, because bytes are widened by
/// taking the even and the odd ones. Right rows are interleaved to match.
template <typename V>
constexpr bool even_odd_order(Arithmetic arithmetic) {
  return V::kEvenOdd && arithmetic != Arithmetic::kRaw && arithmetic != Arithmetic::kWide;
}

/// The memory of the strip's column `column` in a chunk.
[[gnu::always_inline]] inline std::uint16_t* sums_of(const Shape& shape, const Strip& strip,
                                                     const Scratch& scratch, int chunk, int column) {
  const std::ptrdiff_t columns = shape.window + strip.columns();
  return scratch.column_sums + (chunk * columns + shape.window + column - strip.first) * shape.chunk;
}

/// Where the differences of a chunk lie in RowChange::differences and removed_differences.
[[gnu::always_inline]] inline std::ptrdiff_t differences_offset(const Shape& shape, const Strip& strip,
                                                                int chunk, int column) {
  return (static_cast<std::ptrdiff_t>(chunk) * strip.columns() + column - strip.first) * shape.chunk;
}

/// Where a kernel is in the rows of a RowChange: in the right rows, and in the differences.
template <typename V, Arithmetic kA, bool kRecompute>
struct Place {
  using Reg = typename V::Reg;
  static constexpr int kStep = even_odd_order<V>(kA) ? 2 : 1;

  Place(const Shape& shape, const Strip& strip, const RowChange& row, int chunk, int column)
      : left(row.added.left + column) {
    // A right row begins with the last column.
    right = row.added.right +
            kStep * (static_cast<std::ptrdiff_t>(shape.width) - 1 - column + chunk * shape.chunk);
    if constexpr (kRecompute) {
      removed_left = row.removed.left + column;
      to_removed_right = row.removed.right - row.added.right;
    } else {
      differences = row.differences + differences_offset(shape, strip, chunk, column);
      to_removed = row.removed_differences - row.differences;
    }
  }

  inline void next_column(int chunk_size) {
    ++left;
    right -= kStep;
    if constexpr (kRecompute) ++removed_left;
    if constexpr (!kRecompute) differences += chunk_size;
  }

  const std::uint8_t* left;
  const std::uint8_t* right;
  const std::uint8_t* removed_left = nullptr;
  std::ptrdiff_t to_removed_right = 0;  // from `right` to the same place in the row that leaves
  std::uint8_t* differences = nullptr;
  std::ptrdiff_t to_removed = 0;  // from `differences` to those that leave
};

/// The column sums of V::kBytes disparities, and how a row changes them.
///
/// Disparities that only fill up a chunk are compared like the others; with kPadded their differences are
/// taken for 0, so that their sums stay what they begin with and never win.
template <typename V, Arithmetic kA, bool kRecompute, bool kPadded>
struct ColumnUpdate {
  using Reg = typename V::Reg;

  static inline Reg difference(Reg left, Reg right, const std::uint8_t* lane_mask) {
    const Reg all = kA == Arithmetic::kRaw ? V::abs_diff_u8(left, right) : V::abs_diff_small(left, right);
    return kPadded ? V::bit_and(all, V::load_aligned(lane_mask)) : all;
  }

  /// Reads the sums at `sums`, of the disparities from k on, changes them, writes them back and leaves them
  /// in first and second. `left` and `removed_left` are the place's pixels.
  static inline void apply(const Place<V, kA, kRecompute>& place, int k, Reg left, Reg removed_left,
                           const std::uint8_t* lane_mask, std::uint16_t* sums, Reg& first, Reg& second) {
    const Reg added = difference(left, V::load(place.right + k), lane_mask + k);
    Reg removed;
    if constexpr (kRecompute) {
      removed = difference(removed_left, V::load(place.right + place.to_removed_right + k), lane_mask + k);
    } else {
      V::store_aligned(place.differences + k, added);
      removed = V::load_aligned(place.differences + place.to_removed + k);
    }
    first = V::load_aligned(sums);
    second = V::load_aligned(sums + V::kBytes / 2);
    if constexpr (kA == Arithmetic::kRaw) {
      V::change_any(added, removed, first, second);
    } else {
      V::template change_small<shift_of(kA)>(added, removed, first, second);
    }
    V::store_aligned(sums, first);
    V::store_aligned(sums + V::kBytes / 2, second);
  }
};

/// Kernel::add_row for all arithmetics but kWide.
template <typename V, Arithmetic kA, bool kRecompute>
void add_chunks(const Shape& shape, const Strip& strip, const RowChange& row, const Scratch& scratch) {
  using Reg = typename V::Reg;
  for (int chunk = 0; chunk < shape.chunks; ++chunk) {
    std::uint16_t* sums = sums_of(shape, strip, scratch, chunk, strip.first);
    Place<V, kA, kRecompute> place(shape, strip, row, chunk, strip.first);
    const std::uint8_t* lane_mask = scratch.lane_masks + chunk * shape.chunk;
    for (int column = strip.first; column < strip.end; ++column, sums += shape.chunk) {
      const Reg left = V::broadcast8(*place.left);
      const Reg removed_left = kRecompute ? V::broadcast8(*place.removed_left) : left;
      for (int k = 0; k < shape.chunk; k += V::kBytes) {
        Reg first, second;
        ColumnUpdate<V, kA, kRecompute, true>::apply(place, k, left, removed_left, lane_mask, sums + k, first,
                                                     second);
      }
      place.next_column(shape.chunk);
    }
  }
}

}  // namespace stereod::kernels
