// SPDX-License-Identifier: BSD-3-Clause
// The two paths along a grid row, and the winners (docs/matcher.md, section 2.2).
#pragma once

#include <cstdint>

#include "core/match/semiglobal/kernels/kernel.h"

namespace stereod::semiglobal {

/// Kernel::paths_from_right and paths_from_left for disparities in kVectors vectors; 0 means any number.
template <typename V, int kVectors>
class Paths {
  using Reg = typename V::Reg;
  static constexpr int kCapacity = kVectors > 0 ? kVectors : kMaxVectors;

 public:
  // Takes the rows by value, because for the compiler a stored byte may alias the caller's object.
  static void from_right(const SearchParams& params, PathRows rows) {
    const int vectors = kVectors > 0 ? kVectors : params.vectors;
    const int width = params.grid_width();
    const Reg p1 = V::broadcast8(static_cast<std::uint8_t>(params.p1));
    Reg first[kCapacity], second[kCapacity];  // of the two rows, see carry_on()
    clear(vectors, first, second);
    for (int x = width - 1; x >= 0; --x) {
      const int offset = x * vectors * V::kBytes;
      const Reg p2_first = V::broadcast8(rows.p2[0][x + 1]);
      const Reg p2_second = V::broadcast8(rows.p2[1][x + 1]);
#pragma GCC unroll 4
      for (int k = 0; k < vectors; ++k) {
        const int here = offset + k * V::kBytes;
        const auto costs = [&](int row) { return V::load_aligned(rows.costs[row] + here); };
        const Reg b = costs(1), c = costs(2), d = costs(3), e = costs(4);
        const Reg cd = V::average8(c, d);
        const Reg both = V::average8(V::average8(b, c), V::average8(d, e));
        const Reg padding = V::load_aligned(rows.padding + k * V::kBytes);
        const Reg upper = V::bit_or(padding, V::average8(V::average8(V::average8(costs(0), b), cd), both));
        const Reg lower = V::bit_or(padding, V::average8(both, V::average8(cd, V::average8(e, costs(5)))));
        V::store_aligned(rows.smoothed[0] + here, upper);
        V::store_aligned(rows.smoothed[1] + here, lower);
        first[k] = V::add8_saturated(upper, V::min8(first[k], p2_first));
        second[k] = V::add8_saturated(lower, V::min8(second[k], p2_second));
        V::store_aligned(rows.sums[0] + here, first[k]);
        V::store_aligned(rows.sums[1] + here, second[k]);
      }
      carry_on(vectors, p1, first, second);
    }
  }

  static void from_left(const SearchParams& params, PathRows rows) {
    const int vectors = kVectors > 0 ? kVectors : params.vectors;
    const int width = params.grid_width();
    const Reg p1 = V::broadcast8(static_cast<std::uint8_t>(params.p1));
    Reg first[kCapacity], second[kCapacity];
    clear(vectors, first, second);
    for (int x = 0; x < width; ++x) {
      const int offset = x * vectors * V::kBytes;
      rows.winners[0][x] = step_from_left(vectors, rows, 0, x, offset, first);
      rows.winners[1][x] = step_from_left(vectors, rows, 1, x, offset, second);
      carry_on(vectors, p1, first, second);
    }
  }

 private:
  [[gnu::always_inline]] static void clear(int vectors, Reg* first, Reg* second) {
#pragma GCC unroll 4
    for (int k = 0; k < vectors; ++k) first[k] = second[k] = V::broadcast8(0);
  }

  // Extends the path of one row to sample x, whose costs lie at `offset`. Returns the winner as in PathRows.
  [[gnu::always_inline]] static std::uint16_t step_from_left(int vectors, const PathRows& rows, int row,
                                                             int x, int offset, Reg* path) {
    const Reg p2 = V::broadcast8(rows.p2[row][x]);
    Reg minimum = V::broadcast8(255);
#pragma GCC unroll 4
    for (int k = 0; k < vectors; ++k) {
      const int here = offset + k * V::kBytes;
      path[k] = V::add8_saturated(V::load_aligned(rows.smoothed[row] + here), V::min8(path[k], p2));
      const Reg sum = V::add8_saturated(path[k], V::load_aligned(rows.sums[row] + here));
      V::store_aligned(rows.sums[row] + here, sum);
      minimum = k == 0 ? sum : V::min8(minimum, sum);
    }
    return static_cast<std::uint16_t>(V::horizontal_argmin8(minimum));
  }

  // Turns the sums of the paths at a sample into what they add to the next one before the limit P2: the
  // minimum of the sum of each disparity and of its neighbors plus P1, less the minimum of all.
  [[gnu::always_inline]] static void carry_on(int vectors, Reg p1, Reg* first, Reg* second) {
    Reg minimum_first = first[0], minimum_second = second[0];
#pragma GCC unroll 4
    for (int k = 1; k < vectors; ++k) {
      minimum_first = V::min8(minimum_first, first[k]);
      minimum_second = V::min8(minimum_second, second[k]);
    }
    V::horizontal_min8(minimum_first, minimum_second, minimum_first, minimum_second);
    carry_on(vectors, p1, minimum_first, first);
    carry_on(vectors, p1, minimum_second, second);
  }

  [[gnu::always_inline]] static void carry_on(int vectors, Reg p1, Reg minimum, Reg* path) {
    Reg below = V::shift_lanes_up(path[vectors - 1]);
    const Reg beyond = V::shift_lanes_down(path[0]);
#pragma GCC unroll 4
    for (int k = 0; k < vectors; ++k) {
      const Reg here = path[k];
      const Reg above = k + 1 < vectors ? path[k + 1] : beyond;
      path[k] = V::sub8(V::min8(here, V::add8_saturated(V::min8(below, above), p1)), minimum);
      below = here;
    }
  }
};

/// Kernel::count_less_equal for disparities in kVectors vectors; 0 means any number.
template <typename V, int kVectors>
void count_less_equal(const SearchParams& params, const std::uint8_t* sums, const std::uint8_t* limits,
                      std::int16_t* counts) {
  using Reg = typename V::Reg;
  const int vectors = kVectors > 0 ? kVectors : params.vectors, width = params.grid_width();
  for (int x = 0; x < width; ++x) {
    const Reg limit = V::broadcast8(limits[x]);
    Reg count = V::broadcast8(0);
#pragma GCC unroll 4
    for (int k = 0; k < vectors; ++k, sums += V::kBytes) {
      count = V::sub8(count, V::less_equal8(V::load_aligned(sums), limit));  // a true lane is −1
    }
    counts[x] = static_cast<std::int16_t>(V::horizontal_sum8(count));
  }
}

}  // namespace stereod::semiglobal
