// SPDX-License-Identifier: BSD-3-Clause
// Operations on 16 bytes that both x86 vector layers share (SSSE3). vector_scalar.h defines them.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace stereod::kernels {

/// kIsa gives each kernel functions of its own, because each is compiled with different instructions.
template <int kIsa>
struct BytesX86 {
  static void reverse16(const std::uint8_t* in, std::uint8_t* out) {
    const __m128i order = _mm_setr_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    store(out, _mm_shuffle_epi8(load(in), order));
  }
  static void interleave16(const std::uint8_t* a, const std::uint8_t* b, std::uint8_t* out) {
    const __m128i x = load(a);
    const __m128i y = load(b);
    store(out, _mm_unpacklo_epi8(x, y));
    store(out + 16, _mm_unpackhi_epi8(x, y));
  }
  static void split32(const std::uint8_t* in, std::uint8_t* even, std::uint8_t* odd) {
    const __m128i low = _mm_set1_epi16(0xFF);
    const __m128i a = load(in);
    const __m128i b = load(in + 16);
    store(even, _mm_packus_epi16(_mm_and_si128(a, low), _mm_and_si128(b, low)));
    store(odd, _mm_packus_epi16(_mm_srli_epi16(a, 8), _mm_srli_epi16(b, 8)));
  }

 private:
  static __m128i load(const std::uint8_t* p) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p)); }
  static void store(std::uint8_t* p, __m128i a) { _mm_storeu_si128(reinterpret_cast<__m128i*>(p), a); }
};

}  // namespace stereod::kernels
