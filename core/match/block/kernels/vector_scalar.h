// The vector layer in plain C++ (with the compiler's own vector types, which it maps to whatever the CPU's
// baseline has): what every operation means. The others do the same with instructions of their own.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace stereod::kernels {

struct VectorScalar {
  static constexpr int kBytes = 16;
  static constexpr bool kOneSize = true;  // of chunks
  /// Added to every 16-bit sum, modulo 65536, so that min16() may compare signed numbers.
  static constexpr std::uint16_t kBias = 0;
  /// In which order the two halves that widening signed bytes leaves hold them: the even and the odd bytes,
  /// or (false) the lower and the upper eight. Unsigned bytes always widen to lower and upper, except that
  /// vectors of 32 bytes do that in each half for itself.
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

  /// Keeps a value in its register: compilers like to load again what an instruction can take from memory,
  /// and to move what they could leave in place.
  static void pin(Reg&) {}

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

  /// |a − b| of unsigned bytes; small: that differ by at most 127.
  static Reg abs_diff_u8(Reg a, Reg b) {
    const auto x = reinterpret_cast<Bytes>(a);
    const auto y = reinterpret_cast<Bytes>(b);
    return reinterpret_cast<Reg>(x > y ? x - y : y - x);
  }
  static Reg abs_diff_small(Reg a, Reg b) { return abs_diff_u8(a, b); }

  /// Adds the bytes added − removed to 16-bit lanes: differences that fit in a signed byte, times 2^kShift,
  /// or any.
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

  /// 16-bit lanes, modulo 65536; min16 of biased numbers.
  static Reg bit_and(Reg a, Reg b) { return a & b; }
  static Reg add16(Reg a, Reg b) { return a + b; }
  static Reg sub16(Reg a, Reg b) { return a - b; }
  static Reg min16(Reg a, Reg b) { return a < b ? a : b; }
  /// 32-bit lanes: the even or the odd ones of signed 16-bit lanes, times 256; greater32 has all bits or
  /// none; least32 is the least lane of all. Of numbers to compare, the bits are those of finite
  /// floating-point numbers ≥ 2^−126, so that these may be compared instead.
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
  static std::uint32_t least32(Reg a) {
    const auto lanes = reinterpret_cast<Signed32>(a);
    std::int32_t least = lanes[0];
    for (int i = 1; i < 4; ++i) least = lanes[i] < least ? lanes[i] : least;
    return static_cast<std::uint32_t>(least);
  }
  /// The biased number where the mask is 0 plus bias, the largest one where it is 0xFFFF plus bias.
  static Reg masked(Reg a, Reg mask) { return a | mask; }

  /// The two halves of a vector of unsigned bytes that was widened, from and to 2·kBytes of memory in order;
  /// kAligned: memory that is aligned as for store_aligned.
  template <bool kAligned>
  static void store_in_order(std::uint16_t* p, Reg first, Reg second) {
    store(p, first);
    store(p + 8, second);
  }
  static void load_in_order(const std::uint16_t* p, Reg& first, Reg& second) {
    first = load(p);
    second = load(p + 8);
  }

  /// The least lane, less the bias.
  static std::uint16_t least16(Reg a) {
    std::uint16_t least = a[0];
    for (int k = 1; k < kBytes / 2; ++k) least = a[k] < least ? a[k] : least;
    return least;
  }

  /// The least lane less the bias in the low half, in the high half the first place it has among groups of 8
  /// lanes laid over each other (wider vectors fold onto 8 lanes).
  static std::uint32_t least_lane(Reg a) {
    std::uint32_t least = static_cast<std::uint32_t>(a[0]) << 3;  // value and place in one number to compare
    for (std::uint32_t i = 1; i < 8; ++i) {
      const std::uint32_t candidate = static_cast<std::uint32_t>(a[i]) << 3 | i;
      least = candidate < least ? candidate : least;
    }
    return least >> 3 | (least & 7) << 16;
  }

  /// `sums` are 2·kVectors registers, the halves of each vector of bytes after each other; kEvenOddOrder: the
  /// first ones hold the lower disparities of the chunk, the second ones the upper, else every vector holds
  /// a run of disparities. The first place in the chunk whose sum equals `wanted`; there is one.
  template <int kVectors, bool kEvenOddOrder>
  static std::uint32_t first_equal(const Reg* sums, Reg wanted) {
    static_assert(!kEvenOddOrder);
    constexpr int kLast = 2 * kVectors - 1;
    Reg places = Reg{0, 1, 2, 3, 4, 5, 6, 7} + static_cast<std::uint16_t>(8 * kLast);
    Reg first = broadcast16(0xFFFF);
    for (int i = kLast; i >= 0; --i, places -= 8) first = sums[i] == wanted ? places : first;
    return least_lane(first) & 0xFFFF;
  }

  /// xsobel_row() of kBytes pixels; the rows have a pixel more on either side.
  static void xsobel(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int cap,
                     std::uint8_t* out) {
    const auto limit = static_cast<std::int16_t>(cap);
    const auto most = static_cast<std::int16_t>(2 * cap);
    for (int x = 0; x < kBytes; ++x) {
      const auto raised =
          static_cast<std::int16_t>((above[x + 1] - above[x - 1]) + 2 * (row[x + 1] - row[x - 1]) +
                                    (below[x + 1] - below[x - 1]) + limit);
      const std::int16_t positive = raised > 0 ? raised : std::int16_t{0};
      out[x] = static_cast<std::uint8_t>(positive < most ? positive : most);
    }
  }

  // --- lanes of bytes, for the semi-global kernel

  static void store(void* p, Reg a) { std::memcpy(p, &a, sizeof(a)); }
  static Reg bit_or(Reg a, Reg b) { return a | b; }
  static Reg min8(Reg a, Reg b) {
    const auto x = reinterpret_cast<Bytes>(a);
    const auto y = reinterpret_cast<Bytes>(b);
    return reinterpret_cast<Reg>(x < y ? x : y);
  }
  /// Modulo 256; the second never has a borrow here.
  static Reg add8(Reg a, Reg b) {
    return reinterpret_cast<Reg>(reinterpret_cast<Bytes>(a) + reinterpret_cast<Bytes>(b));
  }
  static Reg sub8(Reg a, Reg b) {
    return reinterpret_cast<Reg>(reinterpret_cast<Bytes>(a) - reinterpret_cast<Bytes>(b));
  }
  /// The sum, at most 255.
  static Reg add8_saturated(Reg a, Reg b) {
    const auto x = reinterpret_cast<Bytes>(a);
    const Bytes sum = x + reinterpret_cast<Bytes>(b);
    return reinterpret_cast<Reg>(sum < x ? Bytes{} + std::uint8_t{255} : sum);
  }
  /// (a + b + 1) / 2.
  static Reg average8(Reg a, Reg b) {
    const auto x = reinterpret_cast<Bytes>(a);
    const auto y = reinterpret_cast<Bytes>(b);
    return reinterpret_cast<Reg>((x | y) - ((x ^ y) >> 1));
  }
  /// All bits where a ≤ b.
  static Reg at_most8(Reg a, Reg b) {
    return reinterpret_cast<Reg>(reinterpret_cast<Bytes>(a) <= reinterpret_cast<Bytes>(b));
  }
  /// A table of 16 bytes, and its entries at the places that the indices say; 0 for indices from 128 on.
  /// Indices are below 16, or 128.
  static Reg load_table(const std::uint8_t* p) { return load(p); }
  static Reg look_up(Reg table, Reg indices) {
    const auto entries = reinterpret_cast<Bytes>(table);
    const auto places = reinterpret_cast<Bytes>(indices);
    Bytes found{};
    for (int i = 0; i < 16; ++i) found[i] = places[i] < 16 ? entries[places[i]] : std::uint8_t{0};
    return reinterpret_cast<Reg>(found);
  }
  /// Lane i becomes lane i − 1 or i + 1; what comes in at the end is 255.
  static Reg raise_lanes(Reg a) {
    std::uint8_t bytes[17];
    bytes[0] = 255;
    std::memcpy(bytes + 1, &a, sizeof(a));
    return load(bytes);
  }
  static Reg lower_lanes(Reg a) {
    std::uint8_t bytes[17];
    std::memcpy(bytes, &a, sizeof(a));
    bytes[16] = 255;
    return load(bytes + 1);
  }
  /// In all lanes the least one of each.
  static void least8(Reg a, Reg b, Reg& least_a, Reg& least_b) {
    least_a = broadcast8(static_cast<std::uint8_t>(winner8(a) >> 8));
    least_b = broadcast8(static_cast<std::uint8_t>(winner8(b) >> 8));
  }
  /// 256 times the least lane, plus the first place it has.
  static std::uint32_t winner8(Reg a) {
    const auto bytes = reinterpret_cast<Bytes>(a);
    std::uint32_t least = 0xFFFF;
    for (std::uint32_t i = 0; i < 16; ++i) {
      const std::uint32_t candidate = static_cast<std::uint32_t>(bytes[i]) << 8 | i;
      least = candidate < least ? candidate : least;
    }
    return least;
  }
  /// The sum of all lanes.
  static int sum8(Reg a) {
    const auto bytes = reinterpret_cast<Bytes>(a);
    int sum = 0;
    for (int i = 0; i < 16; ++i) sum += bytes[i];
    return sum;
  }
  /// 32 bytes, the even and the odd ones.
  static void split32(const std::uint8_t* in, std::uint8_t* even, std::uint8_t* odd) {
    for (int i = 0; i < 16; ++i) {
      even[i] = in[2 * i];
      odd[i] = in[2 * i + 1];
    }
  }

 private:
  // Eight bytes of a vector, from byte `from` on, as 16 bits with the sign their type has.
  template <typename Wide, typename Narrow>
  static Wide widened(Narrow a, int from) {
    using Half [[gnu::vector_size(8)]] = std::remove_reference_t<decltype(a[0])>;
    Half half;
    std::memcpy(&half, reinterpret_cast<const char*>(&a) + from, sizeof(half));
    return __builtin_convertvector(half, Wide);
  }
};

}  // namespace stereod::kernels
