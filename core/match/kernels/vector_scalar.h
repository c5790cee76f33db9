// The vector layer in plain C++ (with the compiler's own vector types, which it maps to whatever the CPU's
// baseline has): what every operation means. The others do the same with instructions of their own.
#pragma once

#include <cstdint>
#include <cstring>

namespace stereod::kernels {

struct VectorScalar {
  static constexpr int kBytes = 16;
  // Little-endian: byte 2i is the low half of lane i, byte 2i + 1 its high half.
  using Reg [[gnu::vector_size(16)]] = std::uint16_t;
  using Bytes [[gnu::vector_size(16)]] = std::uint8_t;
  using Signed [[gnu::vector_size(16)]] = std::int16_t;

  static Reg load(const void* p) {
    Reg a;
    std::memcpy(&a, p, sizeof(a));
    return a;
  }
  /// The same, kept in a register: compilers like to load again what an instruction can take from memory,
  /// which costs twice where a load crosses a cache line.
  static Reg load_once(const void* p) { return load(p); }
  static Reg load_aligned(const void* p) { return load(p); }
  static void store(void* p, Reg a) { std::memcpy(p, &a, sizeof(a)); }
  static Reg broadcast8(std::uint8_t value) { return reinterpret_cast<Reg>(Bytes{} + value); }
  static Reg broadcast16(std::uint16_t value) { return Reg{} + value; }

  /// 16 bytes in reverse order. Here and below the 16 or 32 bytes read may overlap those written.
  static void reverse16(const std::uint8_t* in, std::uint8_t* out) {
    std::uint8_t bytes[16];
    for (int i = 0; i < 16; ++i) bytes[i] = in[15 - i];
    std::memcpy(out, bytes, sizeof(bytes));
  }
  /// 16 bytes of a and of b by turns.
  static void interleave16(const std::uint8_t* a, const std::uint8_t* b, std::uint8_t* out) {
    std::uint8_t bytes[32];
    for (int i = 0; i < 16; ++i) {
      bytes[2 * i] = a[i];
      bytes[2 * i + 1] = b[i];
    }
    std::memcpy(out, bytes, sizeof(bytes));
  }

  /// |a − b| of unsigned bytes.
  static Reg abs_diff_u8(Reg a, Reg b) {
    const auto x = reinterpret_cast<Bytes>(a);
    const auto y = reinterpret_cast<Bytes>(b);
    return reinterpret_cast<Reg>(x > y ? x - y : y - x);
  }
  /// a − b of bytes, modulo 256.
  static Reg sub8(Reg a, Reg b) {
    return reinterpret_cast<Reg>(reinterpret_cast<Bytes>(a) - reinterpret_cast<Bytes>(b));
  }
  /// The even bytes, the odd bytes, as 16-bit lanes: unsigned, and signed times 2^kShift.
  static Reg even_u8(Reg a) { return a & 0xFF; }
  static Reg odd_u8(Reg a) { return a >> 8; }
  template <int kShift>
  static Reg even_s8(Reg a) {
    return reinterpret_cast<Reg>(reinterpret_cast<Signed>(a << 8) >> (8 - kShift));
  }
  template <int kShift>
  static Reg odd_s8(Reg a) {
    return reinterpret_cast<Reg>(reinterpret_cast<Signed>(a & 0xFF00) >> (8 - kShift));
  }
  /// 16-bit lanes, modulo 65536.
  static Reg add16(Reg a, Reg b) { return a + b; }
  static Reg sub16(Reg a, Reg b) { return a - b; }
  static Reg bit_or(Reg a, Reg b) { return a | b; }
  static Reg min_u16(Reg a, Reg b) { return a < b ? a : b; }

  /// The least 16-bit lane in the low half, in the high half the first place it has among groups of 8 lanes
  /// laid over each other (wider vectors fold onto 8 lanes).
  static std::uint32_t least_lane(Reg a) {
    std::uint32_t least = static_cast<std::uint32_t>(a[0]) << 3;  // value and place in one number to compare
    for (std::uint32_t i = 1; i < 8; ++i) {
      const std::uint32_t candidate = static_cast<std::uint32_t>(a[i]) << 3 | i;
      least = candidate < least ? candidate : least;
    }
    return least >> 3 | (least & 7) << 16;
  }
  /// `sums` are 2·kVectors registers, the disparities of a chunk's lower half in the even ones and of its
  /// upper half in the odd ones. The lowest disparity whose sum equals `wanted`; there is one.
  template <int kVectors>
  static std::uint32_t first_equal(const Reg* sums, Reg wanted) {
    for (int half = 0; half < 2; ++half) {
      for (int k = 0; k < 8 * kVectors; ++k) {
        if (sums[2 * (k / 8) + half][k % 8] == wanted[0]) {
          return static_cast<std::uint32_t>(half * 8 * kVectors + k);
        }
      }
    }
    return 0;
  }
};

}  // namespace stereod::kernels
