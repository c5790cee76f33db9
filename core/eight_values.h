// Eight 16-bit numbers at a time, in the compiler's own vectors: every CPU here has 16-byte ones, so this is
// for what runs the same on all of them.
#pragma once

#include <cstdint>
#include <cstring>

namespace stereod {

inline constexpr int kEight = 8;
using EightValues [[gnu::vector_size(2 * kEight)]] = std::int16_t;  // a comparison gives −1 where it holds
using EightBytes [[gnu::vector_size(kEight)]] = std::uint8_t;

inline EightValues load_eight(const std::int16_t* p) {
  EightValues values;
  std::memcpy(&values, p, sizeof(values));
  return values;
}

/// Bytes as 16-bit numbers.
inline EightValues load_eight(const std::uint8_t* p) {
  EightBytes bytes;
  std::memcpy(&bytes, p, sizeof(bytes));
  return __builtin_convertvector(bytes, EightValues);
}

inline void store_eight(std::int16_t* p, EightValues values) { std::memcpy(p, &values, sizeof(values)); }

/// Whether any of them is not 0.
inline bool any_of(EightValues values) {
  std::uint64_t halves[2];
  std::memcpy(halves, &values, sizeof(halves));
  return (halves[0] | halves[1]) != 0;
}

}  // namespace stereod
