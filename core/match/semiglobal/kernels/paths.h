// The two paths along a row, and who wins.
#pragma once

#include <cstdint>

#include "core/match/semiglobal/kernels/kernel.h"

namespace stereod::semiglobal {

/// Kernel::paths_from_right and paths_from_left for disparities in kVectors vectors; 0: in any number.
template <typename V, int kVectors>
class Paths {
  using Reg = typename V::Reg;
  static constexpr int kRoom = kVectors > 0 ? kVectors : kMaxVectors;

 public:
  // The rows are taken by value: what is stored might lie in the caller's for all that the compiler knows.
  static void from_right(const Shape& shape, PathRows rows) {
    const int vectors = kVectors > 0 ? kVectors : shape.vectors;
    const int width = shape.grid_width();
    const Reg p1 = V::broadcast8(static_cast<std::uint8_t>(shape.p1));
    Reg first[kRoom], second[kRoom];  // what the paths of the two rows bring along
    clear(vectors, first, second);
    for (int x = width - 1; x >= 0; --x) {
      const int at = x * vectors * V::kBytes;
      const Reg most_first = V::broadcast8(rows.p2[0][x + 1]);
      const Reg most_second = V::broadcast8(rows.p2[1][x + 1]);
#pragma GCC unroll 4
      for (int k = 0; k < vectors; ++k) {
        const int here = at + k * V::kBytes;
        const auto costs = [&](int row) { return V::load_aligned(rows.costs[row] + here); };
        const Reg b = costs(1), c = costs(2), d = costs(3), e = costs(4);
        const Reg cd = V::average8(c, d);
        const Reg both = V::average8(V::average8(b, c), V::average8(d, e));
        const Reg padding = V::load_aligned(rows.padding + k * V::kBytes);
        const Reg upper = V::bit_or(padding, V::average8(V::average8(V::average8(costs(0), b), cd), both));
        const Reg lower = V::bit_or(padding, V::average8(both, V::average8(cd, V::average8(e, costs(5)))));
        V::store_aligned(rows.smoothed[0] + here, upper);
        V::store_aligned(rows.smoothed[1] + here, lower);
        first[k] = V::add8_saturated(upper, V::min8(first[k], most_first));
        second[k] = V::add8_saturated(lower, V::min8(second[k], most_second));
        V::store_aligned(rows.sums[0] + here, first[k]);
        V::store_aligned(rows.sums[1] + here, second[k]);
      }
      pass_on(vectors, p1, first, second);
    }
  }

  static void from_left(const Shape& shape, PathRows rows) {
    const int vectors = kVectors > 0 ? kVectors : shape.vectors;
    const int width = shape.grid_width();
    const Reg p1 = V::broadcast8(static_cast<std::uint8_t>(shape.p1));
    Reg first[kRoom], second[kRoom];
    clear(vectors, first, second);
    for (int x = 0; x < width; ++x) {
      const int at = x * vectors * V::kBytes;
      rows.winners[0][x] = step_from_left(vectors, rows, 0, x, at, first);
      rows.winners[1][x] = step_from_left(vectors, rows, 1, x, at, second);
      pass_on(vectors, p1, first, second);
    }
  }

 private:
  [[gnu::always_inline]] static void clear(int vectors, Reg* first, Reg* second) {
#pragma GCC unroll 4
    for (int k = 0; k < vectors; ++k) first[k] = second[k] = V::broadcast8(0);
  }

  // Extends the path of one row to point x; what sums up there, and the winner's place.
  [[gnu::always_inline]] static std::uint16_t step_from_left(int vectors, const PathRows& rows, int row,
                                                             int x, int at, Reg* path) {
    const Reg most = V::broadcast8(rows.p2[row][x]);
    Reg least = V::broadcast8(255);
#pragma GCC unroll 4
    for (int k = 0; k < vectors; ++k) {
      const int here = at + k * V::kBytes;
      path[k] = V::add8_saturated(V::load_aligned(rows.smoothed[row] + here), V::min8(path[k], most));
      const Reg sum = V::add8_saturated(path[k], V::load_aligned(rows.sums[row] + here));
      V::store_aligned(rows.sums[row] + here, sum);
      least = k == 0 ? sum : V::min8(least, sum);
    }
    return static_cast<std::uint16_t>(V::winner8(least));
  }

  // From the costs of the paths at a point to what they bring along to the next one, before the limit for
  // large steps: the cost of each disparity or, P1 dearer, of its neighbors, less the lowest of all.
  [[gnu::always_inline]] static void pass_on(int vectors, Reg p1, Reg* first, Reg* second) {
    Reg least_first = first[0], least_second = second[0];
#pragma GCC unroll 4
    for (int k = 1; k < vectors; ++k) {
      least_first = V::min8(least_first, first[k]);
      least_second = V::min8(least_second, second[k]);
    }
    V::least8(least_first, least_second, least_first, least_second);
    pass_on(vectors, p1, least_first, first);
    pass_on(vectors, p1, least_second, second);
  }

  [[gnu::always_inline]] static void pass_on(int vectors, Reg p1, Reg least, Reg* path) {
    Reg below = V::raise_lanes(path[vectors - 1]);
    const Reg beyond = V::lower_lanes(path[0]);
#pragma GCC unroll 4
    for (int k = 0; k < vectors; ++k) {
      const Reg here = path[k];
      const Reg above = k + 1 < vectors ? path[k + 1] : beyond;
      path[k] = V::sub8(V::min8(here, V::add8_saturated(V::min8(below, above), p1)), least);
      below = here;
    }
  }
};

/// Kernel::count_at_most for disparities in kVectors vectors; 0: in any number.
template <typename V, int kVectors>
void count_at_most(const Shape& shape, const std::uint8_t* sums, const std::uint8_t* limits,
                   std::int16_t* counts) {
  using Reg = typename V::Reg;
  const int vectors = kVectors > 0 ? kVectors : shape.vectors, width = shape.grid_width();
  for (int x = 0; x < width; ++x) {
    const Reg limit = V::broadcast8(limits[x]);
    Reg count = V::broadcast8(0);
#pragma GCC unroll 4
    for (int k = 0; k < vectors; ++k, sums += V::kBytes) {
      count = V::sub8(count, V::at_most8(V::load_aligned(sums), limit));  // less −1
    }
    counts[x] = static_cast<std::int16_t>(V::sum8(count));
  }
}

}  // namespace stereod::semiglobal
