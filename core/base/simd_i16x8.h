// SPDX-License-Identifier: BSD-3-Clause
// Eight 16-bit numbers at a time, in the compiler's own vector types: every supported CPU has 16-byte
// vectors, so code with these needs no kernel for each instruction set.
#pragma once

#include <cstdint>
#include <cstring>

namespace stereod {

inline constexpr int kI16Lanes = 8;
using I16x8 [[gnu::vector_size(2 * kI16Lanes)]] = std::int16_t;  // a comparison gives −1 where it holds
using U8x8 [[gnu::vector_size(kI16Lanes)]] = std::uint8_t;

inline I16x8 load_i16x8(const std::int16_t* p) {
  I16x8 values;
  std::memcpy(&values, p, sizeof(values));
  return values;
}

/// Loads eight bytes as 16-bit numbers.
inline I16x8 load_i16x8(const std::uint8_t* p) {
  U8x8 bytes;
  std::memcpy(&bytes, p, sizeof(bytes));
  return __builtin_convertvector(bytes, I16x8);
}

inline void store_i16x8(std::int16_t* p, I16x8 values) { std::memcpy(p, &values, sizeof(values)); }

/// Returns whether any lane differs from 0.
inline bool any_of(I16x8 values) {
  std::uint64_t halves[2];
  std::memcpy(halves, &values, sizeof(halves));
  return (halves[0] | halves[1]) != 0;
}

}  // namespace stereod
