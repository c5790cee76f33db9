// Column sums: for every column c and disparity k the sum of |L−R| over the window's rows, kept in memory as
// 16 bits. A new row changes them by the differences that come in less those that leave.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/block/kernels/kernel.h"

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

/// Where the last part of a chunk begins: its upper half where halves are interleaved, else its last vector.
template <typename V>
constexpr int last_part(Arithmetic arithmetic, int chunk) {
  return even_odd_order<V>(arithmetic) ? chunk / 2 : chunk - V::kBytes;
}

/// Which disparity of the chunk that is. A chunk that is wider than the search has its last part begin
/// earlier by as much, so that every lane is a disparity that is searched, some of them twice, and none costs
/// anything for being there to fill up the chunk. Only fewer disparities than the last part begins with leave
/// lanes that are none.
template <typename V>
[[gnu::always_inline]] constexpr int last_part_disparity(const Shape& shape) {
  const int begin = last_part<V>(shape.arithmetic, shape.chunk);
  const int spare = shape.chunks == 1 ? shape.chunk - shape.disparities : 0;
  return spare < begin ? begin - spare : 0;
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
            kStep * (static_cast<std::ptrdiff_t>(shape.width) - 1 - column + shape.first_of(chunk));
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
template <typename V, Arithmetic kA, bool kRecompute>
struct ColumnUpdate {
  using Reg = typename V::Reg;

  [[gnu::always_inline]] static inline Reg difference(Reg left, Reg right) {
    return kA == Arithmetic::kRaw ? V::abs_diff_u8(left, right) : V::abs_diff_small(left, right);
  }

  /// Reads the sums at `sums`, of the chunk's bytes from `at` on, changes them, writes them back and leaves
  /// them in first and second. The last vector's pixels begin with disparity `last` of the chunk where it is
  /// the last part. `left` and `removed_left` are the place's pixels.
  [[gnu::always_inline]] static inline void apply(const Place<V, kA, kRecompute>& place, int at, bool is_last,
                                                  int last, Reg left, Reg removed_left, std::uint16_t* sums,
                                                  Reg& first, Reg& second) {
    // An interleaved row has its last part where it belongs.
    const std::uint8_t* right = place.right + (!even_odd_order<V>(kA) && is_last ? last : at);
    const Reg added = difference(left, V::load(right));
    Reg removed;
    if constexpr (kRecompute) {
      removed = difference(removed_left, V::load(right + place.to_removed_right));
    } else {
      V::store_aligned(place.differences + at, added);
      removed = V::load_aligned(place.differences + place.to_removed + at);
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
    const int last = last_part_disparity<V>(shape);
    for (int column = strip.first; column < strip.end; ++column, sums += shape.chunk) {
      const Reg left = V::broadcast8(*place.left);
      const Reg removed_left = kRecompute ? V::broadcast8(*place.removed_left) : left;
      for (int at = 0; at < shape.chunk; at += V::kBytes) {
        Reg first, second;
        ColumnUpdate<V, kA, kRecompute>::apply(place, at, at + V::kBytes == shape.chunk, last, left,
                                               removed_left, sums + at, first, second);
      }
      place.next_column(shape.chunk);
    }
  }
}

}  // namespace stereod::kernels
