// The one source of the block-matching kernels. Each kernel_<isa>.cpp compiles it for its instruction set,
// with a vector layer V: V::Reg, V::kBytes and the operations of vector_scalar.h.
//
// This header and those it includes are compiled with instructions that the running CPU may lack. Nothing in
// them may come from a header whose inline functions other files use too (the linker keeps one copy of
// those): no std:: functions but memcpy, and every function that is not a template of V says so with a Tag or
// is constexpr.
#pragma once

#include "core/match/block/interpolation.h"
#include "core/match/block/kernels/block_search.h"
#include "core/match/block/kernels/column_sums.h"
#include "core/match/block/kernels/kernel.h"
#include "core/match/block/kernels/row_preparation.h"
#include "core/match/block/kernels/wide_search.h"

namespace stereod::kernels {

/// From the run-time values of a Shape to the functions compiled for them. Chunks have 32, 48 (only with
/// vectors of 16 bytes) or 64 disparities: every further size would make the program larger.
template <typename V>
class Dispatch {
  // Plain C++ is for CPUs that have nothing else: it has one size, to be small.
  static constexpr bool kOneSize = requires { V::kOneSize; };
  static constexpr int kMinChunk = kOneSize ? kMaxChunk : 32;

 public:
  static int chunk_for(int disparities) {
    const int rounded = (disparities + V::kBytes - 1) / V::kBytes * V::kBytes;
    return rounded < kMinChunk ? kMinChunk : rounded;
  }

  static void add_row(const Shape& shape, const Strip& strip, const RowChange& row, const Scratch& scratch) {
    switch (shape.arithmetic) {
      case Arithmetic::kPacked:
        return add<Arithmetic::kPacked>(shape, strip, row, scratch);
      case Arithmetic::kPackedHalves:
        return add<Arithmetic::kPackedHalves>(shape, strip, row, scratch);
      case Arithmetic::kRaw:
        return add<Arithmetic::kRaw>(shape, strip, row, scratch);
      case Arithmetic::kWide:
        return wide<false>(shape, strip, row, scratch, {});
    }
  }

  static void search_row(const Shape& shape, const Strip& strip, const RowChange& row, const Scratch& scratch,
                         const Winners& winners) {
    switch (shape.arithmetic) {
      case Arithmetic::kPacked:
        return search_by_size<Arithmetic::kPacked>(shape, strip, row, scratch, winners);
      case Arithmetic::kPackedHalves:
        return search_by_size<Arithmetic::kPackedHalves>(shape, strip, row, scratch, winners);
      case Arithmetic::kRaw:
        return search_by_size<Arithmetic::kRaw>(shape, strip, row, scratch, winners);
      case Arithmetic::kWide:
        return wide<true>(shape, strip, row, scratch, winners);
    }
  }

 private:
  template <Arithmetic kA>
  static void add(const Shape& shape, const Strip& strip, const RowChange& row, const Scratch& scratch) {
    shape.recompute ? add_chunks<V, kA, true>(shape, strip, row, scratch)
                    : add_chunks<V, kA, false>(shape, strip, row, scratch);
  }

  template <bool kSearch>
  static void wide(const Shape& shape, const Strip& strip, const RowChange& row, const Scratch& scratch,
                   const Winners& out) {
    if (shape.recompute) {
      return WideSearch<V>::template row<kSearch, true, 0>(shape, strip, row, scratch, out);
    }
    // The usual number, where there is room for a function of its own.
    if (!kOneSize && shape.chunk == kMaxChunk) {
      return WideSearch<V>::template row < kSearch, false,
             kOneSize ? 0 : kMaxChunk > (shape, strip, row, scratch, out);
    }
    WideSearch<V>::template row<kSearch, false, 0>(shape, strip, row, scratch, out);
  }

  template <Arithmetic kA>
  static void search_by_size(const Shape& shape, const Strip& strip, const RowChange& row,
                             const Scratch& scratch, const Winners& out) {
    switch (shape.chunk / V::kBytes) {
      case kMaxChunk / V::kBytes:
        return BlockSearch<V, kA, kMaxChunk / V::kBytes>::row(shape, strip, row, scratch, out);
      case 3:  // of vectors of 16 bytes
        if constexpr (V::kBytes == 16 && !kOneSize) {
          return BlockSearch<V, kA, 3>::row(shape, strip, row, scratch, out);
        }
        break;
      default:
        return BlockSearch<V, kA, kMinChunk / V::kBytes>::row(shape, strip, row, scratch, out);
    }
  }
};

/// The table entry of an instruction set.
template <typename V>
constexpr Kernel make_kernel() {
  return {Dispatch<V>::chunk_for, Xsobel<V>::row,          RightRow<V>::prepare, 0xFFFF ^ V::kBias,
          Dispatch<V>::add_row,   Dispatch<V>::search_row, interpolate<float, V>};
}

}  // namespace stereod::kernels
