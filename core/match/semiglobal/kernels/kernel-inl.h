// SPDX-License-Identifier: BSD-3-Clause
// Source of all semi-global kernels. Each kernel_<isa>.cpp compiles it for its instruction set, with a vector
// layer V, whose operations core/match/vector/vector_scalar.h defines.
//
// As in core/match/block/kernels/kernel-inl.h, nothing here may come from a header whose inline functions are
// also used in files compiled for the baseline CPU: no std:: functions, and every function is a template of
// V.
#pragma once

#include "core/match/semiglobal/kernels/cost_rows.h"
#include "core/match/semiglobal/kernels/disparity_rows.h"
#include "core/match/semiglobal/kernels/kernel.h"
#include "core/match/semiglobal/kernels/paths.h"
#include "core/match/vector/xsobel-inl.h"

namespace stereod::semiglobal {

/// Calls the function compiled for the number of vectors; 0 stands for any number.
template <typename V>
class Dispatch {
 public:
  static void paths_from_right(const SearchParams& params, const PathRows& rows) {
    switch (params.vectors) {
      case 1:
        return Paths<V, 1>::from_right(params, rows);
      case 2:
        return Paths<V, 2>::from_right(params, rows);
      case 3:
        return Paths<V, 3>::from_right(params, rows);
      case 4:
        return Paths<V, 4>::from_right(params, rows);
      default:
        return Paths<V, 0>::from_right(params, rows);
    }
  }

  static void paths_from_left(const SearchParams& params, const PathRows& rows) {
    switch (params.vectors) {
      case 1:
        return Paths<V, 1>::from_left(params, rows);
      case 2:
        return Paths<V, 2>::from_left(params, rows);
      case 3:
        return Paths<V, 3>::from_left(params, rows);
      case 4:
        return Paths<V, 4>::from_left(params, rows);
      default:
        return Paths<V, 0>::from_left(params, rows);
    }
  }

  static void count_less_equal(const SearchParams& params, const std::uint8_t* sums,
                               const std::uint8_t* limits, std::int16_t* counts) {
    switch (params.vectors) {
      case 2:
        return semiglobal::count_less_equal<V, 2>(params, sums, limits, counts);
      case 4:
        return semiglobal::count_less_equal<V, 4>(params, sums, limits, counts);
      default:
        return semiglobal::count_less_equal<V, 0>(params, sums, limits, counts);
    }
  }
};

/// Returns the kernel of an instruction set.
template <typename V>
constexpr Kernel make_kernel() {
  return {V::kBytes,
          CensusRows<V>::row,
          kernels::Xsobel<V>::row,
          CensusRows<V>::stripe,
          CostRows<V>::row,
          Dispatch<V>::paths_from_right,
          Dispatch<V>::paths_from_left,
          Dispatch<V>::count_less_equal,
          DisparityRows<V>::refine,
          DisparityRows<V>::median,
          DisparityRows<V>::guide,
          DisparityRows<V>::upsample_columns,
          DisparityRows<V>::interpolate_rows,
          DisparityRows<V>::write_disparities,
          DisparityRows<V>::adapt_p2};
}

}  // namespace stereod::semiglobal
