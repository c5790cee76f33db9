// SPDX-License-Identifier: BSD-3-Clause
// Source of all block-matching kernels. Each kernel_<isa>.cpp compiles it for its instruction set, with a
// vector layer V: V::Reg, V::kBytes and the operations that core/match/vector/vector_scalar.h defines.
//
// This header and those that it includes are compiled with instructions that the running CPU may lack.
// Nothing in them may come from a header whose inline functions are also used in other files, because the
// linker keeps one copy of those: no std:: functions except memcpy, and every function that is not a template
// of V takes a Tag or is constexpr.
#pragma once

#include "core/match/block/interpolation.h"
#include "core/match/block/kernels/block_search.h"
#include "core/match/block/kernels/column_sums.h"
#include "core/match/block/kernels/kernel.h"
#include "core/match/block/kernels/right_row.h"
#include "core/match/block/kernels/wide_search.h"
#include "core/match/vector/xsobel-inl.h"

namespace stereod::kernels {

/// Calls the functions compiled for the run-time values of SearchParams. Chunks have 32, 48 (only with
/// vectors of 16 bytes) or 64 disparities: every further size would make the program larger.
template <typename V>
class Dispatch {
  // Plain C++ is for CPUs without a vector layer of their own. It has one size of chunks, to be small.
  static constexpr bool kOneSize = requires { V::kOneSize; };
  static constexpr int kMinChunk = kOneSize ? kMaxChunk : 32;

 public:
  static int chunk_for(int disparities) {
    const int rounded = (disparities + V::kBytes - 1) / V::kBytes * V::kBytes;
    return rounded < kMinChunk ? kMinChunk : rounded;
  }

  static void add_row(const SearchParams& params, const ColumnTile& tile, const RowChange& row,
                      const Scratch& scratch) {
    switch (params.arithmetic) {
      case Arithmetic::kPacked:
        return add<Arithmetic::kPacked>(params, tile, row, scratch);
      case Arithmetic::kPackedHalves:
        return add<Arithmetic::kPackedHalves>(params, tile, row, scratch);
      case Arithmetic::kRaw:
        return add<Arithmetic::kRaw>(params, tile, row, scratch);
      case Arithmetic::kWide:
        return wide<false>(params, tile, row, scratch, {});
    }
  }

  static void search_row(const SearchParams& params, const ColumnTile& tile, const RowChange& row,
                         const Scratch& scratch, const Winners& winners) {
    switch (params.arithmetic) {
      case Arithmetic::kPacked:
        return search_by_size<Arithmetic::kPacked>(params, tile, row, scratch, winners);
      case Arithmetic::kPackedHalves:
        return search_by_size<Arithmetic::kPackedHalves>(params, tile, row, scratch, winners);
      case Arithmetic::kRaw:
        return search_by_size<Arithmetic::kRaw>(params, tile, row, scratch, winners);
      case Arithmetic::kWide:
        return wide<true>(params, tile, row, scratch, winners);
    }
  }

 private:
  template <Arithmetic kA>
  static void add(const SearchParams& params, const ColumnTile& tile, const RowChange& row,
                  const Scratch& scratch) {
    params.recompute ? add_chunks<V, kA, true>(params, tile, row, scratch)
                     : add_chunks<V, kA, false>(params, tile, row, scratch);
  }

  template <bool kSearch>
  static void wide(const SearchParams& params, const ColumnTile& tile, const RowChange& row,
                   const Scratch& scratch, const Winners& out) {
    if (params.recompute) {
      return WideSearch<V>::template row<kSearch, true, 0>(params, tile, row, scratch, out);
    }
    // The usual number has a function of its own, except in plain C++.
    if (!kOneSize && params.chunk == kMaxChunk) {
      return WideSearch<V>::template row < kSearch, false,
             kOneSize ? 0 : kMaxChunk > (params, tile, row, scratch, out);
    }
    WideSearch<V>::template row<kSearch, false, 0>(params, tile, row, scratch, out);
  }

  template <Arithmetic kA>
  static void search_by_size(const SearchParams& params, const ColumnTile& tile, const RowChange& row,
                             const Scratch& scratch, const Winners& out) {
    switch (params.chunk / V::kBytes) {
      case kMaxChunk / V::kBytes:
        return BlockSearch<V, kA, kMaxChunk / V::kBytes>::row(params, tile, row, scratch, out);
      case 3:  // of vectors of 16 bytes
        if constexpr (V::kBytes == 16 && !kOneSize) {
          return BlockSearch<V, kA, 3>::row(params, tile, row, scratch, out);
        }
        break;
      default:
        return BlockSearch<V, kA, kMinChunk / V::kBytes>::row(params, tile, row, scratch, out);
    }
  }
};

/// Returns the kernel of an instruction set.
template <typename V>
constexpr Kernel make_kernel() {
  return {Dispatch<V>::chunk_for, Xsobel<V>::row,          RightRow<V>::prepare, 0xFFFF ^ V::kBias,
          Dispatch<V>::add_row,   Dispatch<V>::search_row, interpolate<float, V>};
}

}  // namespace stereod::kernels
