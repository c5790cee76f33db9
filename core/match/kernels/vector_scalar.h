// The vector layer in plain C++: what every operation means. The others do the same with instructions.
#pragma once

#include <cstdint>

namespace stereod::kernels {

struct VectorScalar {
  static constexpr int kBytes = 16;
  struct Reg {
    std::uint16_t lane[8];  // byte 2i is the low half of lane i, byte 2i + 1 its high half
  };

  static Reg load(const std::uint8_t* p) {
    return each([p](int i) { return static_cast<std::uint16_t>(p[2 * i] | p[2 * i + 1] << 8); });
  }
  static Reg load(const std::uint16_t* p) {
    return each([p](int i) { return p[i]; });
  }
  static Reg load_aligned(const std::uint16_t* p) { return load(p); }
  static void store(std::uint16_t* p, Reg a) {
    for (int i = 0; i < 8; ++i) p[i] = a.lane[i];
  }
  static Reg broadcast8(std::uint8_t value) {
    return each([value](int) { return static_cast<std::uint16_t>(value * 0x0101); });
  }
  static Reg broadcast16(std::uint16_t value) {
    return each([value](int) { return value; });
  }

  /// |a − b| of unsigned bytes.
  static Reg abs_diff_u8(Reg a, Reg b) {
    return each([&](int i) {
      return static_cast<std::uint16_t>(distance(low(a, i), low(b, i)) | distance(high(a, i), high(b, i))
                                                                             << 8);
    });
  }
  /// a − b of bytes, modulo 256.
  static Reg sub8(Reg a, Reg b) {
    return each([&](int i) {
      return static_cast<std::uint16_t>(((low(a, i) - low(b, i)) & 0xFF) | ((high(a, i) - high(b, i)) & 0xFF)
                                                                               << 8);
    });
  }
  /// The even bytes, the odd bytes, as 16-bit lanes: unsigned, and signed times 2^kShift.
  static Reg even_u8(Reg a) {
    return each([&](int i) { return static_cast<std::uint16_t>(low(a, i)); });
  }
  static Reg odd_u8(Reg a) {
    return each([&](int i) { return static_cast<std::uint16_t>(high(a, i)); });
  }
  template <int kShift>
  static Reg even_s8(Reg a) {
    return each([&](int i) {
      return static_cast<std::uint16_t>(static_cast<std::int8_t>(low(a, i)) * (1 << kShift));
    });
  }
  template <int kShift>
  static Reg odd_s8(Reg a) {
    return each([&](int i) {
      return static_cast<std::uint16_t>(static_cast<std::int8_t>(high(a, i)) * (1 << kShift));
    });
  }
  /// 16-bit lanes, modulo 65536.
  static Reg add16(Reg a, Reg b) {
    return each([&](int i) { return static_cast<std::uint16_t>(a.lane[i] + b.lane[i]); });
  }
  static Reg sub16(Reg a, Reg b) {
    return each([&](int i) { return static_cast<std::uint16_t>(a.lane[i] - b.lane[i]); });
  }
  static Reg bit_or(Reg a, Reg b) {
    return each([&](int i) { return static_cast<std::uint16_t>(a.lane[i] | b.lane[i]); });
  }
  static Reg min_u16(Reg a, Reg b) {
    return each([&](int i) { return a.lane[i] < b.lane[i] ? a.lane[i] : b.lane[i]; });
  }
  /// The least 16-bit lane in the low half, in the high half the first place it has among groups of 8 lanes
  /// laid over each other (wider vectors fold onto 8 lanes).
  static std::uint32_t least_lane(Reg a) {
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < 8; ++i) {
      if (a.lane[i] < a.lane[best]) best = i;
    }
    return a.lane[best] | best << 16;
  }
  /// `sums` are 2·kVectors registers, the disparities of a chunk's lower half in the even ones and of its
  /// upper half in the odd ones. The lowest disparity whose sum equals `wanted`; there is one.
  template <int kVectors>
  static std::uint32_t first_equal(const Reg* sums, Reg wanted) {
    for (int half = 0; half < 2; ++half) {
      for (int k = 0; k < 8 * kVectors; ++k) {
        if (sums[2 * (k / 8) + half].lane[k % 8] == wanted.lane[0]) {
          return static_cast<std::uint32_t>(half * 8 * kVectors + k);
        }
      }
    }
    return 0;
  }

 private:
  static int low(const Reg& a, int i) { return a.lane[i] & 0xFF; }
  static int high(const Reg& a, int i) { return a.lane[i] >> 8; }
  static int distance(int a, int b) { return a > b ? a - b : b - a; }
  template <typename F>
  static Reg each(F f) {
    Reg result;
    for (int i = 0; i < 8; ++i) result.lane[i] = f(i);
    return result;
  }
};

}  // namespace stereod::kernels
