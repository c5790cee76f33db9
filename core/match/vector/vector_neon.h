// SPDX-License-Identifier: BSD-3-Clause
// The vector layer for NEON, of 64-bit and 32-bit ARM. vector_scalar.h defines the operations.
#pragma once

#include <arm_neon.h>

#include <cstdint>

namespace stereod::kernels {

struct VectorNeon {
  static constexpr int kBytes = 16;
  static constexpr std::uint16_t kBias = 0;
  static constexpr bool kEvenOdd = false;
  using Reg = uint16x8_t;

  static Reg load(const void* p) {
    return vreinterpretq_u16_u8(vld1q_u8(static_cast<const std::uint8_t*>(p)));
  }
  static Reg load_aligned(const void* p) { return load(p); }
  static void store_aligned(void* p, Reg a) { vst1q_u8(static_cast<std::uint8_t*>(p), bytes(a)); }
  static Reg broadcast8(std::uint8_t value) { return vreinterpretq_u16_u8(vdupq_n_u8(value)); }
  static Reg broadcast16(std::uint16_t value) { return vdupq_n_u16(value); }
  static void pin(Reg&) {}

  static void reverse16(const std::uint8_t* in, std::uint8_t* out) {
    const uint8x16_t halves = vrev64q_u8(vld1q_u8(in));
    vst1q_u8(out, vcombine_u8(vget_high_u8(halves), vget_low_u8(halves)));
  }
  static void interleave16(const std::uint8_t* a, const std::uint8_t* b, std::uint8_t* out) {
    const uint8x16x2_t pair = {{vld1q_u8(a), vld1q_u8(b)}};
    vst2q_u8(out, pair);
  }

  static Reg abs_diff_u8(Reg a, Reg b) { return vreinterpretq_u16_u8(vabdq_u8(bytes(a), bytes(b))); }
  static Reg abs_diff_small(Reg a, Reg b) { return abs_diff_u8(a, b); }

  // One widening multiply-accumulate scales and adds.
  template <int kShift>
  static void change_small(Reg added, Reg removed, Reg& first, Reg& second) {
    const int8x16_t change = vreinterpretq_s8_u8(vsubq_u8(bytes(added), bytes(removed)));
    if constexpr (kShift == 0) {
      first = vreinterpretq_u16_s16(vaddw_s8(vreinterpretq_s16_u16(first), vget_low_s8(change)));
      second = vreinterpretq_u16_s16(vaddw_s8(vreinterpretq_s16_u16(second), vget_high_s8(change)));
    } else {
      const int8x8_t factor = vdup_n_s8(1 << kShift);
      first = vreinterpretq_u16_s16(vmlal_s8(vreinterpretq_s16_u16(first), vget_low_s8(change), factor));
      second = vreinterpretq_u16_s16(vmlal_s8(vreinterpretq_s16_u16(second), vget_high_s8(change), factor));
    }
  }
  static void change_any(Reg added, Reg removed, Reg& first, Reg& second) {
    first = vaddq_u16(first, vsubl_u8(vget_low_u8(bytes(added)), vget_low_u8(bytes(removed))));
    second = vaddq_u16(second, vsubl_u8(vget_high_u8(bytes(added)), vget_high_u8(bytes(removed))));
  }

  static Reg bit_and(Reg a, Reg b) { return vandq_u16(a, b); }
  static Reg add16(Reg a, Reg b) { return vaddq_u16(a, b); }
  static Reg sub16(Reg a, Reg b) { return vsubq_u16(a, b); }
  static Reg min16(Reg a, Reg b) { return vminq_u16(a, b); }

  static Reg even_256(Reg a) {
    return vreinterpretq_u16_s32(vshrq_n_s32(vshlq_n_s32(vreinterpretq_s32_u16(a), 16), 8));
  }
  static Reg odd_256(Reg a) {
    return vreinterpretq_u16_s32(vshlq_n_s32(vshrq_n_s32(vreinterpretq_s32_u16(a), 16), 8));
  }
  static Reg add32(Reg a, Reg b) {
    return vreinterpretq_u16_u32(vaddq_u32(vreinterpretq_u32_u16(a), vreinterpretq_u32_u16(b)));
  }
  static Reg min32(Reg a, Reg b) {
    return vreinterpretq_u16_u32(vminq_u32(vreinterpretq_u32_u16(a), vreinterpretq_u32_u16(b)));
  }
  static Reg greater32(Reg a, Reg b) {
    return vreinterpretq_u16_u32(vcgtq_u32(vreinterpretq_u32_u16(a), vreinterpretq_u32_u16(b)));
  }
  static std::uint32_t horizontal_min32(Reg a) {
    const uint32x4_t lanes = vreinterpretq_u32_u16(a);
    const uint32x2_t pairs = vpmin_u32(vget_low_u32(lanes), vget_high_u32(lanes));
    return vget_lane_u32(vpmin_u32(pairs, pairs), 0);
  }

  static Reg masked(Reg a, Reg mask) { return vorrq_u16(a, mask); }

  template <bool kAligned>
  static void store_in_order(std::uint16_t* p, Reg first, Reg second) {
    vst1q_u16(p, first);
    vst1q_u16(p + 8, second);
  }
  static void load_in_order(const std::uint16_t* p, Reg& first, Reg& second) {
    first = vld1q_u16(p);
    second = vld1q_u16(p + 8);
  }

  static std::uint16_t horizontal_min16(Reg a) {
#if defined(__aarch64__)
    return vminvq_u16(a);
#else
    uint16x4_t minimum = vmin_u16(vget_low_u16(a), vget_high_u16(a));
    minimum = vpmin_u16(minimum, minimum);
    minimum = vpmin_u16(minimum, minimum);
    return vget_lane_u16(minimum, 0);
#endif
  }
  static std::uint32_t horizontal_argmin16(Reg a) {
    const std::uint16_t minimum = horizontal_min16(a);
    const uint8x8_t equal = vmovn_u16(vceqq_u16(a, vdupq_n_u16(minimum)));
    const std::uint64_t mask = vget_lane_u64(vreinterpret_u64_u8(equal), 0);
    return minimum | static_cast<std::uint32_t>(__builtin_ctzll(mask) / 8) << 16;
  }

  template <int kVectors, bool kEvenOddOrder>
  static std::uint32_t first_equal(const Reg* sums, Reg wanted) {
    static_assert(!kEvenOddOrder);
    static constexpr std::uint16_t kLaneNumbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    Reg number = vld1q_u16(kLaneNumbers);
    Reg first = vdupq_n_u16(0xFFFF);  // in each lane the lowest disparity whose sum equals `wanted`
#pragma GCC unroll 8
    for (int i = 0; i < 2 * kVectors; ++i) {
      first = vminq_u16(first, vornq_u16(number, vceqq_u16(sums[i], wanted)));
      number = vaddq_u16(number, vdupq_n_u16(8));
    }
    return horizontal_min16(first);
  }

  static void xsobel(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int cap,
                     std::uint8_t* out) {
    const int16x8_t lower = gradient(above, row, below, cap);
    const int16x8_t upper = gradient(above + 8, row + 8, below + 8, cap);
    const uint8x16_t positive = vcombine_u8(vqmovun_s16(lower), vqmovun_s16(upper));
    vst1q_u8(out, vminq_u8(positive, vdupq_n_u8(static_cast<std::uint8_t>(2 * cap))));
  }

  static void store(void* p, Reg a) { vst1q_u8(static_cast<std::uint8_t*>(p), bytes(a)); }
  static Reg bit_or(Reg a, Reg b) { return vorrq_u16(a, b); }
  static Reg min8(Reg a, Reg b) { return of(vminq_u8(bytes(a), bytes(b))); }
  static Reg add8(Reg a, Reg b) { return of(vaddq_u8(bytes(a), bytes(b))); }
  static Reg sub8(Reg a, Reg b) { return of(vsubq_u8(bytes(a), bytes(b))); }
  static Reg add8_saturated(Reg a, Reg b) { return of(vqaddq_u8(bytes(a), bytes(b))); }
  static Reg average8(Reg a, Reg b) { return of(vrhaddq_u8(bytes(a), bytes(b))); }
  static Reg less_equal8(Reg a, Reg b) { return of(vcleq_u8(bytes(a), bytes(b))); }
  static Reg load_table(const std::uint8_t* p) { return load(p); }
  static Reg table_lookup(Reg table, Reg indices) {
#if defined(__aarch64__)
    return of(vqtbl1q_u8(bytes(table), bytes(indices)));
#else
    const uint8x8x2_t halves = {{vget_low_u8(bytes(table)), vget_high_u8(bytes(table))}};
    return of(vcombine_u8(vtbl2_u8(halves, vget_low_u8(bytes(indices))),
                          vtbl2_u8(halves, vget_high_u8(bytes(indices)))));
#endif
  }
  static Reg shift_lanes_up(Reg a) { return of(vextq_u8(vdupq_n_u8(255), bytes(a), 15)); }
  static Reg shift_lanes_down(Reg a) { return of(vextq_u8(bytes(a), vdupq_n_u8(255), 1)); }

  static void horizontal_min8(Reg a, Reg b, Reg& minimum_a, Reg& minimum_b) {
    minimum_a = of(vdupq_n_u8(min_byte(bytes(a))));
    minimum_b = of(vdupq_n_u8(min_byte(bytes(b))));
  }
  static std::uint32_t horizontal_argmin8(Reg a) {
    const std::uint8_t minimum = min_byte(bytes(a));
    const uint8x16_t equal = vceqq_u8(bytes(a), vdupq_n_u8(minimum));
    // Four bits a lane.
    const uint8x8_t packed = vshrn_n_u16(vreinterpretq_u16_u8(equal), 4);
    const std::uint64_t mask = vget_lane_u64(vreinterpret_u64_u8(packed), 0);
    return static_cast<std::uint32_t>(minimum) << 8 | static_cast<std::uint32_t>(__builtin_ctzll(mask) / 4);
  }
  static int horizontal_sum8(Reg a) {
    const uint64x2_t sums = vpaddlq_u32(vpaddlq_u16(vpaddlq_u8(bytes(a))));
    return static_cast<int>(vgetq_lane_u64(sums, 0) + vgetq_lane_u64(sums, 1));
  }
  static void split32(const std::uint8_t* in, std::uint8_t* even, std::uint8_t* odd) {
    const uint8x16x2_t pair = vld2q_u8(in);
    vst1q_u8(even, pair.val[0]);
    vst1q_u8(odd, pair.val[1]);
  }

 private:
  static Reg of(uint8x16_t a) { return vreinterpretq_u16_u8(a); }

  static std::uint8_t min_byte(uint8x16_t a) {
#if defined(__aarch64__)
    return vminvq_u8(a);
#else
    uint8x8_t minimum = vpmin_u8(vget_low_u8(a), vget_high_u8(a));
    minimum = vpmin_u8(minimum, minimum);
    minimum = vpmin_u8(minimum, minimum);
    minimum = vpmin_u8(minimum, minimum);
    return vget_lane_u8(minimum, 0);
#endif
  }

  // Returns the gradient + cap of eight pixels.
  static int16x8_t gradient(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                            int cap) {
    const auto difference = [](const std::uint8_t* p) {
      return vreinterpretq_s16_u16(vsubl_u8(vld1_u8(p + 1), vld1_u8(p - 1)));
    };
    const int16x8_t outer = vaddq_s16(difference(above), difference(below));
    return vaddq_s16(vaddq_s16(outer, vshlq_n_s16(difference(row), 1)),
                     vdupq_n_s16(static_cast<std::int16_t>(cap)));
  }

  static uint8x16_t bytes(Reg a) { return vreinterpretq_u8_u16(a); }
};

}  // namespace stereod::kernels
