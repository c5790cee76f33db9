// SPDX-License-Identifier: BSD-3-Clause
// The vector layer for SSSE3 and SSE4.1. vector_scalar.h defines the operations.
#pragma once

#include <immintrin.h>

#include <cstdint>

#include "core/match/vector/bytes_x86.h"

namespace stereod::kernels {

/// kSse41: with pminuw and phminposuw; else sums are biased for pminsw.
template <bool kSse41>
struct VectorSse : BytesX86<kSse41 ? 41 : 3> {
  static constexpr int kBytes = 16;
  static constexpr std::uint16_t kBias = kSse41 ? 0 : 0x8000;
  static constexpr bool kEvenOdd = true;
  using Reg = __m128i;

  static Reg load(const void* p) { return _mm_loadu_si128(static_cast<const __m128i*>(p)); }
  static Reg load_aligned(const void* p) { return _mm_load_si128(static_cast<const __m128i*>(p)); }
  static void store_aligned(void* p, Reg a) { _mm_store_si128(static_cast<__m128i*>(p), a); }
  static Reg broadcast8(std::uint8_t value) { return _mm_set1_epi8(static_cast<char>(value)); }
  static Reg broadcast16(std::uint16_t value) { return _mm_set1_epi16(static_cast<short>(value)); }
  static void pin(Reg& a) { asm("" : "+x"(a)); }

  static Reg abs_diff_u8(Reg a, Reg b) { return _mm_or_si128(_mm_subs_epu8(a, b), _mm_subs_epu8(b, a)); }
  // b was just loaded, so its register may be overwritten.
  static Reg abs_diff_small(Reg a, Reg b) { return _mm_abs_epi8(_mm_sub_epi8(b, a)); }

  // pmaddubsw with one of two factors zero widens and scales in one instruction; with factors 1 and −1 it
  // subtracts neighboring unsigned bytes.
  template <int kShift>
  static void change_small(Reg added, Reg removed, Reg& first, Reg& second) {
    const Reg change = _mm_sub_epi8(added, removed);
    first = _mm_add_epi16(first, _mm_maddubs_epi16(_mm_set1_epi16(1 << kShift), change));
    second =
        _mm_add_epi16(second, _mm_maddubs_epi16(_mm_set1_epi16(static_cast<short>(256 << kShift)), change));
  }
  static void change_any(Reg added, Reg removed, Reg& first, Reg& second) {
    const Reg factors = _mm_set1_epi16(static_cast<short>(0xFF01));
    first = _mm_add_epi16(first, _mm_maddubs_epi16(_mm_unpacklo_epi8(added, removed), factors));
    second = _mm_add_epi16(second, _mm_maddubs_epi16(_mm_unpackhi_epi8(added, removed), factors));
  }

  static Reg bit_and(Reg a, Reg b) { return _mm_and_si128(a, b); }
  static Reg add16(Reg a, Reg b) { return _mm_add_epi16(a, b); }
  static Reg sub16(Reg a, Reg b) { return _mm_sub_epi16(a, b); }
  static Reg min16(Reg a, Reg b) {
#if defined(__SSE4_1__)
    if constexpr (kSse41) return _mm_min_epu16(a, b);
#endif
    return _mm_min_epi16(a, b);
  }

  static Reg even_256(Reg a) { return _mm_madd_epi16(a, _mm_set1_epi32(0x100)); }
  static Reg odd_256(Reg a) { return _mm_madd_epi16(a, _mm_set1_epi32(0x100'0000)); }
  static Reg add32(Reg a, Reg b) { return _mm_add_epi32(a, b); }
  static Reg min32(Reg a, Reg b) {
#if defined(__SSE4_1__)
    if constexpr (kSse41) return _mm_min_epi32(a, b);
#endif
    return _mm_castps_si128(_mm_min_ps(_mm_castsi128_ps(a), _mm_castsi128_ps(b)));
  }
  static Reg greater32(Reg a, Reg b) { return _mm_cmpgt_epi32(a, b); }
  static std::uint32_t horizontal_min32(Reg a) {
    a = min32(a, _mm_unpackhi_epi64(a, a));
    a = min32(a, _mm_shuffle_epi32(a, _MM_SHUFFLE(3, 3, 1, 1)));
    return static_cast<std::uint32_t>(_mm_cvtsi128_si32(a));
  }

  static Reg masked(Reg a, Reg mask) { return kSse41 ? _mm_or_si128(a, mask) : _mm_max_epi16(a, mask); }

  template <bool kAligned>
  static void store_in_order(std::uint16_t* p, Reg first, Reg second) {
    kAligned ? store_aligned(p, first) : store(p, first);
    kAligned ? store_aligned(p + 8, second) : store(p + 8, second);
  }
  static void load_in_order(const std::uint16_t* p, Reg& first, Reg& second) {
    first = load(p);
    second = load(p + 8);
  }

  static std::uint16_t horizontal_min16(Reg a) {
#if defined(__SSE4_1__)
    if constexpr (kSse41) return static_cast<std::uint16_t>(horizontal_argmin16(a));
#endif
    return static_cast<std::uint16_t>(_mm_cvtsi128_si32(fold(a)) ^ kBias);
  }
  static std::uint32_t horizontal_argmin16(Reg a) {
#if defined(__SSE4_1__)
    if constexpr (kSse41) return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_minpos_epu16(a)));
#endif
    const Reg minimum = fold(a);
    const Reg everywhere = _mm_shuffle_epi32(_mm_shufflelo_epi16(minimum, 0), 0);
    const auto equal = static_cast<unsigned>(_mm_movemask_epi8(_mm_cmpeq_epi16(a, everywhere)));
    return ((static_cast<std::uint32_t>(_mm_cvtsi128_si32(minimum)) ^ kBias) & 0xFFFF) |
           static_cast<std::uint32_t>(__builtin_ctz(equal) / 2) << 16;
  }

  template <int kVectors, bool kEvenOddOrder>
  static std::uint32_t first_equal(const Reg* sums, Reg wanted) {
    std::uint64_t equal = 0;
#pragma GCC unroll 8
    for (int pair = 0; pair < kVectors; ++pair) {  // 16 disparities, as 16 bits
      const Reg first = sums[register_of<kVectors, kEvenOddOrder>(2 * pair)];
      const Reg second = sums[register_of<kVectors, kEvenOddOrder>(2 * pair + 1)];
      const Reg bytes = _mm_packs_epi16(_mm_cmpeq_epi16(first, wanted), _mm_cmpeq_epi16(second, wanted));
      equal |= static_cast<std::uint64_t>(static_cast<unsigned>(_mm_movemask_epi8(bytes))) << (16 * pair);
    }
    return static_cast<std::uint32_t>(__builtin_ctzll(equal));
  }

  // Computes above + 2·row with one pmaddubsw, then adds below; pixels to the right minus pixels to the left.
  static void xsobel(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int cap,
                     std::uint8_t* out) {
    const Reg above_right = load(above + 1), row_right = load(row + 1), below_right = load(below + 1);
    const Reg above_left = load(above - 1), row_left = load(row - 1), below_left = load(below - 1);
    const Reg lower =
        gradient(_mm_unpacklo_epi8(above_right, row_right), _mm_unpacklo_epi8(above_left, row_left),
                 _mm_unpacklo_epi8(below_right, below_left), cap);
    const Reg upper =
        gradient(_mm_unpackhi_epi8(above_right, row_right), _mm_unpackhi_epi8(above_left, row_left),
                 _mm_unpackhi_epi8(below_right, below_left), cap);
    const Reg maximum = broadcast8(static_cast<std::uint8_t>(2 * cap));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_min_epu8(_mm_packus_epi16(lower, upper), maximum));
  }

  static void store(void* p, Reg a) { _mm_storeu_si128(static_cast<__m128i*>(p), a); }
  static Reg bit_or(Reg a, Reg b) { return _mm_or_si128(a, b); }
  static Reg min8(Reg a, Reg b) { return _mm_min_epu8(a, b); }
  static Reg add8(Reg a, Reg b) { return _mm_add_epi8(a, b); }
  static Reg sub8(Reg a, Reg b) { return _mm_sub_epi8(a, b); }
  static Reg add8_saturated(Reg a, Reg b) { return _mm_adds_epu8(a, b); }
  static Reg average8(Reg a, Reg b) { return _mm_avg_epu8(a, b); }
  static Reg less_equal8(Reg a, Reg b) { return _mm_cmpeq_epi8(_mm_min_epu8(a, b), a); }
  static Reg load_table(const std::uint8_t* p) { return load_aligned(p); }
  static Reg table_lookup(Reg table, Reg indices) { return _mm_shuffle_epi8(table, indices); }
  static Reg shift_lanes_up(Reg a) { return _mm_alignr_epi8(a, _mm_set1_epi8(-1), 15); }
  static Reg shift_lanes_down(Reg a) { return _mm_alignr_epi8(_mm_set1_epi8(-1), a, 1); }

  static void horizontal_min8(Reg a, Reg b, Reg& minimum_a, Reg& minimum_b) {
#if defined(__SSE4_1__)
    if constexpr (kSse41) {  // minimum of byte pairs, as 16 bits
      const Reg pairs_a = _mm_minpos_epu16(_mm_min_epu8(a, _mm_srli_epi16(a, 8)));
      const Reg pairs_b = _mm_minpos_epu16(_mm_min_epu8(b, _mm_srli_epi16(b, 8)));
      minimum_a = _mm_shuffle_epi8(pairs_a, _mm_setzero_si128());
      minimum_b = _mm_shuffle_epi8(pairs_b, _mm_setzero_si128());
      return;
    }
#endif
    Reg both = _mm_min_epu8(_mm_unpacklo_epi64(a, b), _mm_unpackhi_epi64(a, b));
    both = _mm_min_epu8(both, _mm_srli_epi64(both, 32));
    both = _mm_min_epu8(both, _mm_srli_epi64(both, 16));
    both = _mm_min_epu8(both, _mm_srli_epi64(both, 8));
    minimum_a = _mm_shuffle_epi8(both, _mm_setzero_si128());
    minimum_b = _mm_shuffle_epi8(both, _mm_set1_epi8(8));
  }

  static std::uint32_t horizontal_argmin8(Reg a) {
#if defined(__SSE4_1__)
    if constexpr (kSse41) {
      const Reg places = _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
      const Reg pairs = _mm_min_epu16(_mm_unpacklo_epi8(places, a), _mm_unpackhi_epi8(places, a));
      return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_minpos_epu16(pairs))) & 0xFFFF;
    }
#endif
    Reg minimum, unused;
    horizontal_min8(a, a, minimum, unused);
    const auto equal = static_cast<unsigned>(_mm_movemask_epi8(_mm_cmpeq_epi8(a, minimum)));
    return (static_cast<std::uint32_t>(_mm_cvtsi128_si32(minimum)) & 0xFF) << 8 |
           static_cast<std::uint32_t>(__builtin_ctz(equal));
  }

  static int horizontal_sum8(Reg a) {
    const Reg sums = _mm_sad_epu8(a, _mm_setzero_si128());
    return _mm_cvtsi128_si32(_mm_add_epi32(sums, _mm_unpackhi_epi64(sums, sums)));
  }

 private:
  // Returns the minimum lane in the two lowest lanes.
  static Reg fold(Reg a) {
    Reg minimum = min16(a, _mm_shuffle_epi32(a, _MM_SHUFFLE(1, 0, 3, 2)));
    minimum = min16(minimum, _mm_shuffle_epi32(minimum, _MM_SHUFFLE(2, 3, 0, 1)));
    return min16(minimum, _mm_shufflelo_epi16(minimum, _MM_SHUFFLE(2, 3, 0, 1)));
  }

  // Returns the gradient + cap from pairs of bytes; packing clips values below 0.
  static Reg gradient(Reg right, Reg left, Reg below, int cap) {
    const Reg one_two = _mm_set1_epi16(0x0201);
    const Reg one_less_one = _mm_set1_epi16(static_cast<short>(0xFF01));
    const Reg upper_rows = _mm_sub_epi16(_mm_maddubs_epi16(right, one_two), _mm_maddubs_epi16(left, one_two));
    return _mm_add_epi16(_mm_add_epi16(upper_rows, _mm_maddubs_epi16(below, one_less_one)),
                         broadcast16(static_cast<std::uint16_t>(cap)));
  }

  // Returns the number of the register that holds the `position`-th group of 8 disparities of the chunk.
  template <int kVectors, bool kEvenOddOrder>
  static constexpr int register_of(int position) {
    if (!kEvenOddOrder) return position;
    return position < kVectors ? 2 * position : 2 * (position - kVectors) + 1;
  }
};

}  // namespace stereod::kernels
