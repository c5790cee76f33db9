// SPDX-License-Identifier: BSD-3-Clause
// The vector layer in plain C++, with the compiler's own vector types. Defines what every operation means;
// the other layers do the same with instructions of their CPU.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace stereod::kernels {

struct VectorScalar {
  static constexpr int kBytes = 16;
  static constexpr bool kOneSize = true;  // one size of chunks, to keep the program small
  /// Offset of every 16-bit sum, modulo 65536, so that min16() may compare signed numbers.
  static constexpr std::uint16_t kBias = 0;
  /// What the two results of widening signed bytes hold: the even and the odd bytes (true), or the lower and
  /// the upper eight (false). Unsigned bytes always widen to lower and upper; vectors of 32 bytes do so
  /// within each half.
  static constexpr bool kEvenOdd = false;
  using Reg [[gnu::vector_size(16)]] = std::uint16_t;
  using Bytes [[gnu::vector_size(16)]] = std::uint8_t;
  using SignedBytes [[gnu::vector_size(16)]] = std::int8_t;
  using Signed [[gnu::vector_size(16)]] = std::int16_t;
  using Signed32 [[gnu::vector_size(16)]] = std::int32_t;

  static Reg load(const void* p) {
    Reg a;
    std::memcpy(&a, p, sizeof(a));
    return a;
  }
  static Reg load_aligned(const void* p) { return load(p); }
  static void store_aligned(void* p, Reg a) { std::memcpy(p, &a, sizeof(a)); }
  static Reg broadcast8(std::uint8_t value) { return reinterpret_cast<Reg>(Bytes{} + value); }
  static Reg broadcast16(std::uint16_t value) { return Reg{} + value; }

  /// Forces a value to stay in its register: compilers reload operands that an instruction can take from
  /// memory, and move values that could stay.
  static void pin(Reg&) {}

  /// Reverses 16 bytes. Here and below the 16 or 32 bytes read may overlap those written.
  static void reverse16(const std::uint8_t* in, std::uint8_t* out) {
    std::uint8_t bytes[16];
    for (int i = 0; i < 16; ++i) bytes[i] = in[15 - i];
    std::memcpy(out, bytes, sizeof(bytes));
  }
  /// Interleaves 16 bytes of a and of b.
  static void interleave16(const std::uint8_t* a, const std::uint8_t* b, std::uint8_t* out) {
    std::uint8_t bytes[32];
    for (int i = 0; i < 16; ++i) {
      bytes[2 * i] = a[i];
      bytes[2 * i + 1] = b[i];
    }
    std::memcpy(out, bytes, sizeof(bytes));
  }

  /// Returns |a − b| of unsigned bytes; _small: of bytes that differ by at most 127.
  static Reg abs_diff_u8(Reg a, Reg b) {
    const auto x = reinterpret_cast<Bytes>(a);
    const auto y = reinterpret_cast<Bytes>(b);
    return reinterpret_cast<Reg>(x > y ? x - y : y - x);
  }
  static Reg abs_diff_small(Reg a, Reg b) { return abs_diff_u8(a, b); }

  /// Adds the bytes `added` − `removed` to 16-bit lanes; _small: differences that fit in a signed byte, times
  /// 2^kShift.
  template <int kShift>
  static void change_small(Reg added, Reg removed, Reg& first, Reg& second) {
    const auto change =
        reinterpret_cast<SignedBytes>(reinterpret_cast<Bytes>(added) - reinterpret_cast<Bytes>(removed));
    first += reinterpret_cast<Reg>(widened<Signed>(change, 0) << kShift);
    second += reinterpret_cast<Reg>(widened<Signed>(change, 8) << kShift);
  }
  static void change_any(Reg added, Reg removed, Reg& first, Reg& second) {
    const auto in = reinterpret_cast<Bytes>(added);
    const auto out = reinterpret_cast<Bytes>(removed);
    first += widened<Reg>(in, 0) - widened<Reg>(out, 0);
    second += widened<Reg>(in, 8) - widened<Reg>(out, 8);
  }

  /// 16-bit lanes, modulo 65536; min16 compares biased numbers.
  static Reg bit_and(Reg a, Reg b) { return a & b; }
  static Reg add16(Reg a, Reg b) { return a + b; }
  static Reg sub16(Reg a, Reg b) { return a - b; }
  static Reg min16(Reg a, Reg b) { return a < b ? a : b; }
  /// 32-bit lanes. even_256, odd_256: the even or odd signed 16-bit lanes, times 256. greater32: all bits or
  /// none of each lane. horizontal_min32: the minimum of all lanes. The bits of numbers to compare are those
  /// of finite floating-point numbers ≥ 2^−126, so that a layer may compare floating-point numbers instead.
  static Reg even_256(Reg a) { return reinterpret_cast<Reg>(reinterpret_cast<Signed32>(a) << 16 >> 8); }
  static Reg odd_256(Reg a) { return reinterpret_cast<Reg>(reinterpret_cast<Signed32>(a) >> 16 << 8); }
  static Reg add32(Reg a, Reg b) {
    return reinterpret_cast<Reg>(reinterpret_cast<Signed32>(a) + reinterpret_cast<Signed32>(b));
  }
  static Reg min32(Reg a, Reg b) {
    const auto x = reinterpret_cast<Signed32>(a);
    const auto y = reinterpret_cast<Signed32>(b);
    return reinterpret_cast<Reg>(x < y ? x : y);
  }
  static Reg greater32(Reg a, Reg b) {
    return reinterpret_cast<Reg>(reinterpret_cast<Signed32>(a) > reinterpret_cast<Signed32>(b));
  }
  static std::uint32_t horizontal_min32(Reg a) {
    const auto lanes = reinterpret_cast<Signed32>(a);
    std::int32_t minimum = lanes[0];
    for (int i = 1; i < 4; ++i) minimum = lanes[i] < minimum ? lanes[i] : minimum;
    return static_cast<std::uint32_t>(minimum);
  }
  /// Returns the biased number where the mask is 0 + bias, the maximum where it is 0xFFFF + bias.
  static Reg masked(Reg a, Reg mask) { return a | mask; }

  /// Store and load the two results of widening unsigned bytes, as 2·kBytes of memory in order. kAligned: the
  /// memory is aligned as for store_aligned.
  template <bool kAligned>
  static void store_in_order(std::uint16_t* p, Reg first, Reg second) {
    store(p, first);
    store(p + 8, second);
  }
  static void load_in_order(const std::uint16_t* p, Reg& first, Reg& second) {
    first = load(p);
    second = load(p + 8);
  }

  /// Returns the minimum lane without bias.
  static std::uint16_t horizontal_min16(Reg a) {
    std::uint16_t minimum = a[0];
    for (int k = 1; k < kBytes / 2; ++k) minimum = a[k] < minimum ? a[k] : minimum;
    return minimum;
  }

  /// Returns the minimum lane without bias in the low half, and in the high half the first of 8 lanes that
  /// has it (wider vectors are folded onto 8 lanes).
  static std::uint32_t horizontal_argmin16(Reg a) {
    std::uint32_t minimum = static_cast<std::uint32_t>(a[0]) << 3;  // value and lane in one number to compare
    for (std::uint32_t i = 1; i < 8; ++i) {
      const std::uint32_t candidate = static_cast<std::uint32_t>(a[i]) << 3 | i;
      minimum = candidate < minimum ? candidate : minimum;
    }
    return minimum >> 3 | (minimum & 7) << 16;
  }

  /// Returns the first disparity of the chunk whose sum equals @p wanted; there must be one. @p sums are
  /// 2·kVectors registers, the two halves of each vector of bytes side by side. kEvenOddOrder: the first
  /// halves hold the lower disparities of the chunk, the second ones the upper; else each vector holds a run.
  template <int kVectors, bool kEvenOddOrder>
  static std::uint32_t first_equal(const Reg* sums, Reg wanted) {
    static_assert(!kEvenOddOrder);
    constexpr int kLast = 2 * kVectors - 1;
    Reg disparities = Reg{0, 1, 2, 3, 4, 5, 6, 7} + static_cast<std::uint16_t>(8 * kLast);
    Reg first = broadcast16(0xFFFF);
    for (int i = kLast; i >= 0; --i, disparities -= 8) first = sums[i] == wanted ? disparities : first;
    return horizontal_argmin16(first) & 0xFFFF;
  }

  /// xsobel_row() of kBytes pixels; one more pixel can be read on both sides of each row.
  static void xsobel(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int cap,
                     std::uint8_t* out) {
    const auto limit = static_cast<std::int16_t>(cap);
    const auto maximum = static_cast<std::int16_t>(2 * cap);
    for (int x = 0; x < kBytes; ++x) {
      const auto raised =
          static_cast<std::int16_t>((above[x + 1] - above[x - 1]) + 2 * (row[x + 1] - row[x - 1]) +
                                    (below[x + 1] - below[x - 1]) + limit);
      const std::int16_t positive = raised > 0 ? raised : std::int16_t{0};
      out[x] = static_cast<std::uint8_t>(positive < maximum ? positive : maximum);
    }
  }

  // --- 8-bit lanes, for the semi-global kernel

  static void store(void* p, Reg a) { std::memcpy(p, &a, sizeof(a)); }
  static Reg bit_or(Reg a, Reg b) { return a | b; }
  static Reg min8(Reg a, Reg b) {
    const auto x = reinterpret_cast<Bytes>(a);
    const auto y = reinterpret_cast<Bytes>(b);
    return reinterpret_cast<Reg>(x < y ? x : y);
  }
  /// Modulo 256; callers of sub8 never cause a borrow.
  static Reg add8(Reg a, Reg b) {
    return reinterpret_cast<Reg>(reinterpret_cast<Bytes>(a) + reinterpret_cast<Bytes>(b));
  }
  static Reg sub8(Reg a, Reg b) {
    return reinterpret_cast<Reg>(reinterpret_cast<Bytes>(a) - reinterpret_cast<Bytes>(b));
  }
  /// Returns min(a + b, 255).
  static Reg add8_saturated(Reg a, Reg b) {
    const auto x = reinterpret_cast<Bytes>(a);
    const Bytes sum = x + reinterpret_cast<Bytes>(b);
    return reinterpret_cast<Reg>(sum < x ? Bytes{} + std::uint8_t{255} : sum);
  }
  /// Returns (a + b + 1) / 2.
  static Reg average8(Reg a, Reg b) {
    const auto x = reinterpret_cast<Bytes>(a);
    const auto y = reinterpret_cast<Bytes>(b);
    return reinterpret_cast<Reg>((x | y) - ((x ^ y) >> 1));
  }
  /// Returns all bits set where a ≤ b.
  static Reg less_equal8(Reg a, Reg b) {
    return reinterpret_cast<Reg>(reinterpret_cast<Bytes>(a) <= reinterpret_cast<Bytes>(b));
  }
  /// Loads a table of 16 bytes, and returns its entries at @p indices [0…15, or 128 for the result 0].
  static Reg load_table(const std::uint8_t* p) { return load(p); }
  static Reg table_lookup(Reg table, Reg indices) {
    const auto entries = reinterpret_cast<Bytes>(table);
    const auto lanes = reinterpret_cast<Bytes>(indices);
    Bytes result{};
    for (int i = 0; i < 16; ++i) result[i] = lanes[i] < 16 ? entries[lanes[i]] : std::uint8_t{0};
    return reinterpret_cast<Reg>(result);
  }
  /// Return in lane i the lane i − 1 (up) or i + 1 (down), and 255 at the free end.
  static Reg shift_lanes_up(Reg a) {
    std::uint8_t bytes[17];
    bytes[0] = 255;
    std::memcpy(bytes + 1, &a, sizeof(a));
    return load(bytes);
  }
  static Reg shift_lanes_down(Reg a) {
    std::uint8_t bytes[17];
    std::memcpy(bytes, &a, sizeof(a));
    bytes[16] = 255;
    return load(bytes + 1);
  }
  /// Broadcasts the minimum lane of each of two vectors.
  static void horizontal_min8(Reg a, Reg b, Reg& minimum_a, Reg& minimum_b) {
    minimum_a = broadcast8(static_cast<std::uint8_t>(horizontal_argmin8(a) >> 8));
    minimum_b = broadcast8(static_cast<std::uint8_t>(horizontal_argmin8(b) >> 8));
  }
  /// Returns 256 · the minimum lane + the first lane that has it.
  static std::uint32_t horizontal_argmin8(Reg a) {
    const auto bytes = reinterpret_cast<Bytes>(a);
    std::uint32_t minimum = 0xFFFF;
    for (std::uint32_t i = 0; i < 16; ++i) {
      const std::uint32_t candidate = static_cast<std::uint32_t>(bytes[i]) << 8 | i;
      minimum = candidate < minimum ? candidate : minimum;
    }
    return minimum;
  }
  /// Returns the sum of all lanes.
  static int horizontal_sum8(Reg a) {
    const auto bytes = reinterpret_cast<Bytes>(a);
    int sum = 0;
    for (int i = 0; i < 16; ++i) sum += bytes[i];
    return sum;
  }
  /// Splits 32 bytes into the even and the odd ones.
  static void split32(const std::uint8_t* in, std::uint8_t* even, std::uint8_t* odd) {
    for (int i = 0; i < 16; ++i) {
      even[i] = in[2 * i];
      odd[i] = in[2 * i + 1];
    }
  }

 private:
  // Widens eight bytes of a vector, from byte `from` on, to 16 bits, with the sign of their type.
  template <typename Wide, typename Narrow>
  static Wide widened(Narrow a, int from) {
    using Half [[gnu::vector_size(8)]] = std::remove_reference_t<decltype(a[0])>;
    Half half;
    std::memcpy(&half, reinterpret_cast<const char*>(&a) + from, sizeof(half));
    return __builtin_convertvector(half, Wide);
  }
};

}  // namespace stereod::kernels
