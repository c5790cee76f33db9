// SPDX-License-Identifier: BSD-3-Clause
// The vector layer for AVX2. vector_scalar.h defines the operations.
#pragma once

#include <immintrin.h>

#include <cstdint>

#include "core/match/vector/bytes_x86.h"

namespace stereod::kernels {

struct VectorAvx2 : BytesX86<2> {
  static constexpr int kBytes = 32;
  static constexpr std::uint16_t kBias = 0;
  static constexpr bool kEvenOdd = true;
  using Reg = __m256i;

  static Reg load(const void* p) { return _mm256_loadu_si256(static_cast<const __m256i*>(p)); }
  static Reg load_aligned(const void* p) { return _mm256_load_si256(static_cast<const __m256i*>(p)); }
  static void store_aligned(void* p, Reg a) { _mm256_store_si256(static_cast<__m256i*>(p), a); }
  static Reg broadcast8(std::uint8_t value) { return _mm256_set1_epi8(static_cast<char>(value)); }
  static Reg broadcast16(std::uint16_t value) { return _mm256_set1_epi16(static_cast<short>(value)); }
  static void pin(Reg& a) { asm("" : "+x"(a)); }

  static Reg abs_diff_u8(Reg a, Reg b) {
    return _mm256_or_si256(_mm256_subs_epu8(a, b), _mm256_subs_epu8(b, a));
  }
  static Reg abs_diff_small(Reg a, Reg b) { return _mm256_abs_epi8(_mm256_sub_epi8(a, b)); }

  template <int kShift>
  static void change_small(Reg added, Reg removed, Reg& first, Reg& second) {
    const Reg change = _mm256_sub_epi8(added, removed);
    first = _mm256_add_epi16(first, _mm256_maddubs_epi16(_mm256_set1_epi16(1 << kShift), change));
    second = _mm256_add_epi16(
        second, _mm256_maddubs_epi16(_mm256_set1_epi16(static_cast<short>(256 << kShift)), change));
  }
  static void change_any(Reg added, Reg removed, Reg& first, Reg& second) {
    const Reg factors = _mm256_set1_epi16(static_cast<short>(0xFF01));
    first = _mm256_add_epi16(first, _mm256_maddubs_epi16(_mm256_unpacklo_epi8(added, removed), factors));
    second = _mm256_add_epi16(second, _mm256_maddubs_epi16(_mm256_unpackhi_epi8(added, removed), factors));
  }

  static Reg bit_and(Reg a, Reg b) { return _mm256_and_si256(a, b); }
  static Reg add16(Reg a, Reg b) { return _mm256_add_epi16(a, b); }
  static Reg sub16(Reg a, Reg b) { return _mm256_sub_epi16(a, b); }
  static Reg min16(Reg a, Reg b) { return _mm256_min_epu16(a, b); }

  static Reg even_256(Reg a) { return _mm256_madd_epi16(a, _mm256_set1_epi32(0x100)); }
  static Reg odd_256(Reg a) { return _mm256_madd_epi16(a, _mm256_set1_epi32(0x100'0000)); }
  static Reg add32(Reg a, Reg b) { return _mm256_add_epi32(a, b); }
  static Reg min32(Reg a, Reg b) { return _mm256_min_epi32(a, b); }
  static Reg greater32(Reg a, Reg b) { return _mm256_cmpgt_epi32(a, b); }
  static std::uint32_t horizontal_min32(Reg a) {
    __m128i minimum = _mm_min_epi32(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
    minimum = _mm_min_epi32(minimum, _mm_unpackhi_epi64(minimum, minimum));
    minimum = _mm_min_epi32(minimum, _mm_srli_epi64(minimum, 32));
    return static_cast<std::uint32_t>(_mm_cvtsi128_si32(minimum));
  }

  static Reg masked(Reg a, Reg mask) { return _mm256_or_si256(a, mask); }

  // Unpacking works within each half of the vector, so the halves must be exchanged.
  template <bool kAligned>
  static void store_in_order(std::uint16_t* p, Reg first, Reg second) {
    store(p, _mm256_permute2x128_si256(first, second, 0x20));
    store(p + 16, _mm256_permute2x128_si256(first, second, 0x31));
  }
  static void load_in_order(const std::uint16_t* p, Reg& first, Reg& second) {
    const Reg lower = load(p);
    const Reg upper = load(p + 16);
    first = _mm256_permute2x128_si256(lower, upper, 0x20);
    second = _mm256_permute2x128_si256(lower, upper, 0x31);
  }

  static std::uint16_t horizontal_min16(Reg a) { return static_cast<std::uint16_t>(horizontal_argmin16(a)); }
  static std::uint32_t horizontal_argmin16(Reg a) {
    const __m128i folded = _mm_min_epu16(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
    return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_minpos_epu16(folded)));
  }

  template <int kVectors, bool kEvenOddOrder>
  static std::uint32_t first_equal(const Reg* sums, Reg wanted) {
    std::uint64_t equal = 0;
#pragma GCC unroll 8
    for (int pair = 0; pair < kVectors; ++pair) {  // 32 disparities, as 32 bits
      const Reg first = sums[register_of<kVectors, kEvenOddOrder>(2 * pair)];
      const Reg second = sums[register_of<kVectors, kEvenOddOrder>(2 * pair + 1)];
      Reg bytes = _mm256_packs_epi16(_mm256_cmpeq_epi16(first, wanted), _mm256_cmpeq_epi16(second, wanted));
      // packs works within each half, as unpack does.
      if constexpr (kEvenOddOrder) bytes = _mm256_permute4x64_epi64(bytes, _MM_SHUFFLE(3, 1, 2, 0));
      equal |= static_cast<std::uint64_t>(static_cast<unsigned>(_mm256_movemask_epi8(bytes))) << (32 * pair);
    }
    return static_cast<std::uint32_t>(__builtin_ctzll(equal));
  }

  // Computes above + 2·row with one pmaddubsw, then adds below; pixels to the right minus pixels to the left.
  static void xsobel(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int cap,
                     std::uint8_t* out) {
    const Reg above_right = load(above + 1), row_right = load(row + 1), below_right = load(below + 1);
    const Reg above_left = load(above - 1), row_left = load(row - 1), below_left = load(below - 1);
    const Reg lower =
        gradient(_mm256_unpacklo_epi8(above_right, row_right), _mm256_unpacklo_epi8(above_left, row_left),
                 _mm256_unpacklo_epi8(below_right, below_left), cap);
    const Reg upper =
        gradient(_mm256_unpackhi_epi8(above_right, row_right), _mm256_unpackhi_epi8(above_left, row_left),
                 _mm256_unpackhi_epi8(below_right, below_left), cap);
    const Reg maximum = broadcast8(static_cast<std::uint8_t>(2 * cap));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                        _mm256_min_epu8(_mm256_packus_epi16(lower, upper), maximum));
  }

  static void store(void* p, Reg a) { _mm256_storeu_si256(static_cast<__m256i*>(p), a); }
  static Reg bit_or(Reg a, Reg b) { return _mm256_or_si256(a, b); }
  static Reg min8(Reg a, Reg b) { return _mm256_min_epu8(a, b); }
  static Reg add8(Reg a, Reg b) { return _mm256_add_epi8(a, b); }
  static Reg sub8(Reg a, Reg b) { return _mm256_sub_epi8(a, b); }
  static Reg add8_saturated(Reg a, Reg b) { return _mm256_adds_epu8(a, b); }
  static Reg average8(Reg a, Reg b) { return _mm256_avg_epu8(a, b); }
  static Reg less_equal8(Reg a, Reg b) { return _mm256_cmpeq_epi8(_mm256_min_epu8(a, b), a); }
  static Reg load_table(const std::uint8_t* p) {
    return _mm256_broadcastsi128_si256(_mm_load_si128(reinterpret_cast<const __m128i*>(p)));
  }
  static Reg table_lookup(Reg table, Reg indices) { return _mm256_shuffle_epi8(table, indices); }
  static Reg shift_lanes_up(Reg a) {
    return _mm256_alignr_epi8(a, _mm256_permute2x128_si256(a, _mm256_set1_epi8(-1), 0x02), 15);
  }
  static Reg shift_lanes_down(Reg a) {
    return _mm256_alignr_epi8(_mm256_permute2x128_si256(a, _mm256_set1_epi8(-1), 0x21), a, 1);
  }

  // Takes the minimum of byte pairs as 16 bits, then of all lanes.
  static Reg horizontal_min8(Reg a) {
    const __m128i bytes = _mm_min_epu8(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
    return _mm256_broadcastb_epi8(_mm_minpos_epu16(_mm_min_epu8(bytes, _mm_srli_epi16(bytes, 8))));
  }
  static void horizontal_min8(Reg a, Reg b, Reg& minimum_a, Reg& minimum_b) {
    minimum_a = horizontal_min8(a);
    minimum_b = horizontal_min8(b);
  }

  static std::uint32_t horizontal_argmin8(Reg a) {
    const Reg places = _mm256_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19,
                                        20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31);
    return horizontal_argmin16(
               _mm256_min_epu16(_mm256_unpacklo_epi8(places, a), _mm256_unpackhi_epi8(places, a))) &
           0xFFFF;
  }

  static int horizontal_sum8(Reg a) {
    const Reg sums = _mm256_sad_epu8(a, _mm256_setzero_si256());
    const __m128i two = _mm_add_epi32(_mm256_castsi256_si128(sums), _mm256_extracti128_si256(sums, 1));
    return _mm_cvtsi128_si32(_mm_add_epi32(two, _mm_unpackhi_epi64(two, two)));
  }

 private:
  // Returns the gradient + cap from pairs of bytes; packing clips values below 0.
  static Reg gradient(Reg right, Reg left, Reg below, int cap) {
    const Reg one_two = _mm256_set1_epi16(0x0201);
    const Reg one_less_one = _mm256_set1_epi16(static_cast<short>(0xFF01));
    const Reg upper_rows =
        _mm256_sub_epi16(_mm256_maddubs_epi16(right, one_two), _mm256_maddubs_epi16(left, one_two));
    return _mm256_add_epi16(_mm256_add_epi16(upper_rows, _mm256_maddubs_epi16(below, one_less_one)),
                            broadcast16(static_cast<std::uint16_t>(cap)));
  }

  // Returns the number of the register that holds the `position`-th group of 16 disparities of the chunk.
  template <int kVectors, bool kEvenOddOrder>
  static constexpr int register_of(int position) {
    if (!kEvenOddOrder) return position;
    return position < kVectors ? 2 * position : 2 * (position - kVectors) + 1;
  }
};

}  // namespace stereod::kernels
