// The one source of the semi-global kernels. Each kernel_<isa>.cpp compiles it for its instruction set, with
// a vector layer V: core/match/block/kernels/vector_scalar.h says what its operations do.
//
// As with core/match/block/kernels/kernel-inl.h, nothing here may come from a header whose inline functions
// other files use too: no std:: functions, and every function is a template of V.
#pragma once

#include "core/match/block/kernels/row_preparation.h"
#include "core/match/semiglobal/grid_rows.h"
#include "core/match/semiglobal/kernels/cost_row.h"
#include "core/match/semiglobal/kernels/kernel.h"
#include "core/match/semiglobal/kernels/paths.h"

namespace stereod::semiglobal {

/// From the run-time number of vectors to the functions compiled for it; 0 stands for any number.
template <typename V>
class Dispatch {
 public:
  static void paths_from_right(const Shape& shape, const PathRows& rows) {
    switch (shape.vectors) {
      case 1:
        return Paths<V, 1>::from_right(shape, rows);
      case 2:
        return Paths<V, 2>::from_right(shape, rows);
      case 3:
        return Paths<V, 3>::from_right(shape, rows);
      case 4:
        return Paths<V, 4>::from_right(shape, rows);
      default:
        return Paths<V, 0>::from_right(shape, rows);
    }
  }

  static void paths_from_left(const Shape& shape, const PathRows& rows) {
    switch (shape.vectors) {
      case 1:
        return Paths<V, 1>::from_left(shape, rows);
      case 2:
        return Paths<V, 2>::from_left(shape, rows);
      case 3:
        return Paths<V, 3>::from_left(shape, rows);
      case 4:
        return Paths<V, 4>::from_left(shape, rows);
      default:
        return Paths<V, 0>::from_left(shape, rows);
    }
  }

  static void count_at_most(const Shape& shape, const std::uint8_t* sums, const std::uint8_t* limits,
                            std::int16_t* counts) {
    switch (shape.vectors) {
      case 2:
        return semiglobal::count_at_most<V, 2>(shape, sums, limits, counts);
      case 4:
        return semiglobal::count_at_most<V, 4>(shape, sums, limits, counts);
      default:
        return semiglobal::count_at_most<V, 0>(shape, sums, limits, counts);
    }
  }
};

/// The table entry of an instruction set.
template <typename V>
constexpr Kernel make_kernel() {
  return {V::kBytes,
          CensusRows<V>::row,
          kernels::Xsobel<V>::row,
          CensusRows<V>::stripe,
          CostRows<V>::row,
          Dispatch<V>::paths_from_right,
          Dispatch<V>::paths_from_left,
          Dispatch<V>::count_at_most,
          GridRows<V>::interpolate,
          GridRows<V>::median,
          GridRows<V>::likeness,
          GridRows<V>::widen,
          GridRows<V>::between,
          GridRows<V>::disparities,
          GridRows<V>::step_limits};
}

}  // namespace stereod::semiglobal
