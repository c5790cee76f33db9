// The vector layer for SSSE3 and SSE4.1. What each operation means stands in vector_scalar.h.
#pragma once

#include <immintrin.h>

#include <cstdint>

#include "core/match/kernels/bytes_x86.h"

namespace stereod::kernels {

/// kSse41: pminuw and phminposuw are there; else they are built from older instructions.
template <bool kSse41>
struct VectorSse : BytesX86<kSse41 ? 41 : 3> {
  static constexpr int kBytes = 16;
  using Reg = __m128i;

  static Reg load(const void* p) { return _mm_loadu_si128(static_cast<const __m128i*>(p)); }
  static Reg load_once(const void* p) {
    Reg a = load(p);
    asm("" : "+x"(a));
    return a;
  }
  static Reg load_aligned(const void* p) { return _mm_load_si128(static_cast<const __m128i*>(p)); }
  static void store(void* p, Reg a) { _mm_storeu_si128(static_cast<__m128i*>(p), a); }
  static Reg broadcast8(std::uint8_t value) { return _mm_set1_epi8(static_cast<char>(value)); }
  static Reg broadcast16(std::uint16_t value) { return _mm_set1_epi16(static_cast<short>(value)); }

  static Reg abs_diff_u8(Reg a, Reg b) { return _mm_or_si128(_mm_subs_epu8(a, b), _mm_subs_epu8(b, a)); }
  static Reg sub8(Reg a, Reg b) { return _mm_sub_epi8(a, b); }
  static Reg even_u8(Reg a) { return _mm_and_si128(a, _mm_set1_epi16(0xFF)); }
  static Reg odd_u8(Reg a) { return _mm_srli_epi16(a, 8); }
  // pmaddubsw with one of its two factors zero widens and scales in one instruction.
  template <int kShift>
  static Reg even_s8(Reg a) {
    return _mm_maddubs_epi16(_mm_set1_epi16(1 << kShift), a);
  }
  template <int kShift>
  static Reg odd_s8(Reg a) {
    return _mm_maddubs_epi16(_mm_set1_epi16(static_cast<short>(256 << kShift)), a);
  }
  static Reg add16(Reg a, Reg b) { return _mm_add_epi16(a, b); }
  static Reg sub16(Reg a, Reg b) { return _mm_sub_epi16(a, b); }
  static Reg bit_or(Reg a, Reg b) { return _mm_or_si128(a, b); }

  static Reg min_u16(Reg a, Reg b) {
#if defined(__SSE4_1__)
    if constexpr (kSse41) return _mm_min_epu16(a, b);
#endif
    return _mm_sub_epi16(a, _mm_subs_epu16(a, b));
  }
  static std::uint32_t least_lane(Reg a) {
#if defined(__SSE4_1__)
    if constexpr (kSse41) return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_minpos_epu16(a)));
#endif
    Reg least = min_u16(a, _mm_shuffle_epi32(a, _MM_SHUFFLE(1, 0, 3, 2)));
    least = min_u16(least, _mm_shuffle_epi32(least, _MM_SHUFFLE(2, 3, 0, 1)));
    least = min_u16(least, _mm_or_si128(_mm_slli_epi32(least, 16), _mm_srli_epi32(least, 16)));
    const auto equal = static_cast<unsigned>(_mm_movemask_epi8(_mm_cmpeq_epi16(a, least)));
    return (static_cast<std::uint32_t>(_mm_cvtsi128_si32(least)) & 0xFFFF) |
           static_cast<std::uint32_t>(__builtin_ctz(equal) / 2) << 16;
  }

  template <int kVectors>
  static std::uint32_t first_equal(const Reg* sums, Reg wanted) {
    std::uint64_t equal = 0;
#pragma GCC unroll 8
    for (int pair = 0; pair < kVectors; ++pair) {  // 16 disparities, as 16 bits
      const int i = 2 * pair;
      const Reg first = sums[register_of<kVectors>(i)];
      const Reg second = sums[register_of<kVectors>(i + 1)];
      const Reg bytes = _mm_packs_epi16(_mm_cmpeq_epi16(first, wanted), _mm_cmpeq_epi16(second, wanted));
      equal |= static_cast<std::uint64_t>(static_cast<unsigned>(_mm_movemask_epi8(bytes))) << (16 * pair);
    }
    return static_cast<std::uint32_t>(__builtin_ctzll(equal));
  }

 private:
  // Which register holds the `position`-th group of 8 disparities of the chunk.
  template <int kVectors>
  static constexpr int register_of(int position) {
    return position < kVectors ? 2 * position : 2 * (position - kVectors) + 1;
  }
};

}  // namespace stereod::kernels
