// Column sums: for every column c and disparity k the sum of |L−R| over the window's rows, kept in memory as 16
// bits. A new row changes them by the differences that come in less those that leave.
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

/// Bytes by which the right row's bytes of one column lie before those of the column to its left.
template <typename V>
constexpr int right_step(Arithmetic arithmetic) {
  return even_odd_order<V>(arithmetic) ? 2 : 1;
}

/// Where the right row's bytes for column c, disparity `first` of a chunk begin.
template <typename V, Arithmetic kA>
inline std::ptrdiff_t right_offset(const Shape& shape, int column, int first) {
  return right_step<V>(kA) * (static_cast<std::ptrdiff_t>(shape.width) - 1 - column + first);
}

/// The memory of the strip's column `column` in a chunk.
[[gnu::always_inline]] inline std::uint16_t* sums_of(const Shape& shape, const Strip& strip, const Scratch& scratch, int chunk,
                              int column) {
  const std::ptrdiff_t columns = shape.window + strip.columns();
  return scratch.column_sums + (chunk * columns + shape.window + column - strip.first) * shape.chunk;
}

/// Where the differences of a chunk lie in RowChange::differences.
[[gnu::always_inline]] inline std::uint8_t* differences_of(const Shape& shape, const Strip& strip, const RowChange& row, int chunk,
                                    int column) {
  return row.differences +
         (static_cast<std::ptrdiff_t>(chunk) * strip.columns() + column - strip.first) * shape.chunk;
}

/// The column sums of V::kBytes disparities, and how a row changes them.
template <typename V, Arithmetic kA, bool kRecompute>
struct ColumnUpdate {
  using Reg = typename V::Reg;

  static inline Reg difference(Reg left, Reg right) {
    return kA == Arithmetic::kRaw ? V::abs_diff_u8(left, right) : V::abs_diff_small(left, right);
  }

  /// Reads the sums at `sums`, changes them, writes them back and leaves them in first and second.
  static inline void apply(Reg left, const std::uint8_t* right, Reg removed_left,
                           const std::uint8_t* removed_right, std::uint8_t* differences, std::uint16_t* sums,
                           Reg& first, Reg& second) {
    const Reg added = difference(left, V::load(right));
    Reg removed;
    if constexpr (kRecompute) {
      removed = difference(removed_left, V::load(removed_right));
    } else {
      removed = V::load_aligned(differences);
    }
    first = V::load_aligned(sums);
    second = V::load_aligned(sums + V::kBytes / 2);
    if constexpr (kA == Arithmetic::kRaw) {
      V::change_any(added, removed, first, second);
    } else {
      V::template change_small<shift_of(kA)>(added, removed, first, second);
    }
    if constexpr (!kRecompute) V::store_aligned(differences, added);
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
    std::uint8_t* differences = kRecompute ? nullptr : differences_of(shape, strip, row, chunk, strip.first);
    for (int column = strip.first; column < strip.end; ++column, sums += shape.chunk) {
      const Reg left = V::broadcast8(row.added.left[column]);
      const std::ptrdiff_t at = right_offset<V, kA>(shape, column, chunk * shape.chunk);
      const Reg removed_left = kRecompute ? V::broadcast8(row.removed.left[column]) : left;
      const std::uint8_t* removed_right = kRecompute ? row.removed.right + at : nullptr;
      for (int k = 0; k < shape.chunk; k += V::kBytes) {
        Reg first, second;
        ColumnUpdate<V, kA, kRecompute>::apply(left, row.added.right + at + k, removed_left,
                                               removed_right + k, differences + k, sums + k, first, second);
      }
      if constexpr (!kRecompute) differences += shape.chunk;
    }
  }
}

}  // namespace stereod::kernels
