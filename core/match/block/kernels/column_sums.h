// SPDX-License-Identifier: BSD-3-Clause
// Column sums: for every column c and disparity k the sum of |L−R| over the rows of the window, in memory,
// with 16 bits. A new row adds its differences and subtracts those of the row that leaves.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/block/kernels/kernel.h"

namespace stereod::kernels {

/// Returns the binary logarithm of the factor of costs in sums; the low bits hold the number of a group.
[[gnu::always_inline]] constexpr int shift_of(Arithmetic arithmetic) {
  return arithmetic == Arithmetic::kPacked ? 3 : arithmetic == Arithmetic::kPackedHalves ? 2 : 0;
}

/// Returns whether the registers of a chunk hold its lower and its upper half by turns, because bytes are
/// widened by taking the even and the odd ones. Right rows are interleaved to match.
template <typename V>
constexpr bool even_odd_order(Arithmetic arithmetic) {
  return V::kEvenOdd && arithmetic != Arithmetic::kRaw && arithmetic != Arithmetic::kWide;
}

/// Returns the lane at which the tail of a chunk begins: its upper half where halves are interleaved, else
/// its last vector.
template <typename V>
constexpr int tail_begin(Arithmetic arithmetic, int chunk) {
  return even_odd_order<V>(arithmetic) ? chunk / 2 : chunk - V::kBytes;
}

/// Returns the disparity of the chunk at which its tail begins. In a chunk with more lanes than disparities
/// the tail begins that much earlier: every lane is a disparity that is searched, some of them twice, and no
/// lane needs a mask. Lanes without a disparity remain only if there are fewer disparities than tail_begin().
template <typename V>
[[gnu::always_inline]] constexpr int tail_disparity(const SearchParams& params) {
  const int begin = tail_begin<V>(params.arithmetic, params.chunk);
  const int spare = params.chunks == 1 ? params.chunk - params.disparities : 0;
  return spare < begin ? begin - spare : 0;
}

/// Returns the column sums of column @p column of the row in a chunk.
[[gnu::always_inline]] inline std::uint16_t* sums_of(const SearchParams& params, const ColumnTile& tile,
                                                     const Scratch& scratch, int chunk, int column) {
  const std::ptrdiff_t columns = params.window + tile.columns();
  return scratch.column_sums + (chunk * columns + params.window + column - tile.first) * params.chunk;
}

/// Returns the offset of the differences of a column in RowChange::differences and removed_differences.
[[gnu::always_inline]] inline std::ptrdiff_t differences_offset(const SearchParams& params,
                                                                const ColumnTile& tile, int chunk,
                                                                int column) {
  return (static_cast<std::ptrdiff_t>(chunk) * tile.columns() + column - tile.first) * params.chunk;
}

/// The position of a kernel in the rows of a RowChange: in the left and right rows, and in the differences.
template <typename V, Arithmetic kA, bool kRecompute>
struct Cursor {
  using Reg = typename V::Reg;
  static constexpr int kStep = even_odd_order<V>(kA) ? 2 : 1;

  Cursor(const SearchParams& params, const ColumnTile& tile, const RowChange& row, int chunk, int column)
      : left(row.added.left + column) {
    // A right row is reversed: it begins with the last column.
    right = row.added.right +
            kStep * (static_cast<std::ptrdiff_t>(params.width) - 1 - column + params.first_of(chunk));
    if constexpr (kRecompute) {
      removed_left = row.removed.left + column;
      to_removed_right = row.removed.right - row.added.right;
    } else {
      differences = row.differences + differences_offset(params, tile, chunk, column);
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
  std::ptrdiff_t to_removed_right = 0;  // from `right` to the same pixel of the row that leaves
  std::uint8_t* differences = nullptr;
  std::ptrdiff_t to_removed = 0;  // from `differences` to those of the row that leaves
};

/// Changes the column sums of V::kBytes disparities by a row.
template <typename V, Arithmetic kA, bool kRecompute>
struct ColumnUpdate {
  using Reg = typename V::Reg;

  [[gnu::always_inline]] static inline Reg difference(Reg left, Reg right) {
    return kA == Arithmetic::kRaw ? V::abs_diff_u8(left, right) : V::abs_diff_small(left, right);
  }

  /// Changes the sums at @p sums, of the disparities from lane @p offset of the chunk on, and returns them in
  /// @p first and @p second. With @p is_tail, which means the last vector, the disparities begin with number
  /// @p tail of the chunk. @p left and @p removed_left are the broadcast pixels of the cursor.
  [[gnu::always_inline]] static inline void apply(const Cursor<V, kA, kRecompute>& cursor, int offset,
                                                  bool is_tail, int tail, Reg left, Reg removed_left,
                                                  std::uint16_t* sums, Reg& first, Reg& second) {
    // An interleaved row has its tail in place.
    const std::uint8_t* right = cursor.right + (!even_odd_order<V>(kA) && is_tail ? tail : offset);
    const Reg added = difference(left, V::load(right));
    Reg removed;
    if constexpr (kRecompute) {
      removed = difference(removed_left, V::load(right + cursor.to_removed_right));
    } else {
      V::store_aligned(cursor.differences + offset, added);
      removed = V::load_aligned(cursor.differences + cursor.to_removed + offset);
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

/// Kernel::add_row for all arithmetics except kWide.
template <typename V, Arithmetic kA, bool kRecompute>
void add_chunks(const SearchParams& params, const ColumnTile& tile, const RowChange& row,
                const Scratch& scratch) {
  using Reg = typename V::Reg;
  for (int chunk = 0; chunk < params.chunks; ++chunk) {
    std::uint16_t* sums = sums_of(params, tile, scratch, chunk, tile.first);
    Cursor<V, kA, kRecompute> cursor(params, tile, row, chunk, tile.first);
    const int tail = tail_disparity<V>(params);
    for (int column = tile.first; column < tile.end; ++column, sums += params.chunk) {
      const Reg left = V::broadcast8(*cursor.left);
      const Reg removed_left = kRecompute ? V::broadcast8(*cursor.removed_left) : left;
      for (int offset = 0; offset < params.chunk; offset += V::kBytes) {
        Reg first, second;
        ColumnUpdate<V, kA, kRecompute>::apply(cursor, offset, offset + V::kBytes == params.chunk, tail, left,
                                               removed_left, sums + offset, first, second);
      }
      cursor.next_column(params.chunk);
    }
  }
}

}  // namespace stereod::kernels
