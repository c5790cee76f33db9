// SPDX-License-Identifier: BSD-3-Clause
// Rows of subsampled disparities, one vector at a time, in the compiler's own vector types (docs/matcher.md,
// sections 2.3 and 2.5).
#pragma once

#include <cstdint>

#include "core/match/semiglobal/kernels/kernel.h"

namespace stereod::semiglobal {

/// The compiler's vector types of kBytes bytes. Bytes has as many lanes as Values, Pixels twice as many.
template <int kBytes>
struct VectorTypes;

template <>
struct VectorTypes<16> {
  using Values [[gnu::vector_size(16)]] = SubsampledDisparity;
  using Ints [[gnu::vector_size(16)]] = std::int32_t;
  using Reals [[gnu::vector_size(16)]] = float;
  using Bytes [[gnu::vector_size(8)]] = std::uint8_t;
  using Pixels [[gnu::vector_size(16)]] = std::uint8_t;
};

template <>
struct VectorTypes<32> {
  using Values [[gnu::vector_size(32)]] = SubsampledDisparity;
  using Ints [[gnu::vector_size(32)]] = std::int32_t;
  using Reals [[gnu::vector_size(32)]] = float;
  using Bytes [[gnu::vector_size(16)]] = std::uint8_t;
  using Pixels [[gnu::vector_size(32)]] = std::uint8_t;
};

/// Kernel::refine_winners and the functions of the kernel after it.
template <typename V>
class DisparityRows {
  static constexpr int kColumns = V::kBytes / 2;
  using Values = typename VectorTypes<V::kBytes>::Values;  // a comparison gives −1 where it holds
  using Bytes = typename VectorTypes<V::kBytes>::Bytes;
  using Pixels = typename VectorTypes<V::kBytes>::Pixels;
  static_assert(2 * kColumns <= kDisparityMargin, "the median looks at the vectors before and after");

 public:
  static void refine(const SearchParams& params, const WinnerRow& winners, SubsampledDisparity* out) {
    constexpr int kFar = 20'000;  // [columns] more than any disparity
    const int width = params.grid_width();
    const Values lanes = ascending() * static_cast<SubsampledDisparity>(params.decimation_x);
    for (int x = 0; x < width; x += kColumns) {
      const Values k = load_bytes(winners.index + x);
      const Values minimum = load(winners.winners + x) >> 8 & SubsampledDisparity{0xFF};
      const Values before = load_bytes(winners.sum_before + x);
      const Values after = load_bytes(winners.sum_after + x);
      const Values sixteenths = 16 * k + vertex(before - after, before + after - 2 * minimum);
      const int column = x * params.decimation_x - params.min_disparity;
      const auto first = static_cast<SubsampledDisparity>(column < kFar ? column : kFar);
      const Values match = lanes + first - k;
      store(out + x, 2 * sixteenths | (match < Values{}));  // kNoDisparity has all bits set
    }
  }

  static void median(const SubsampledDisparity* above, const SubsampledDisparity* row,
                     const SubsampledDisparity* below, int width, bool fill, SubsampledDisparity* out) {
    // The bits to set in samples that had no disparity.
    const auto mark = static_cast<SubsampledDisparity>(fill ? 1 : kNoDisparity);
    for (int x = 0; x < width; x += kColumns) {
      const auto column = [&](int u) { return sorted(load(above + u), load(row + u), load(below + u)); };
      const Values here = load(row + x);
      const Column own = column(x);
      const Values of_nine = median_of(column(x - 1), own, column(x + 1));
      // A thin upright thing. kNoDisparity is never within kClose of something that near.
      const Values to_next = lesser(own.maximum - own.middle, own.middle - own.minimum);
      const Values thin = (own.middle > of_nine + 2 * kNear) & (to_next < Values{} + 2 * kClose);
      const Values median = thin < Values{} ? own.middle : of_nine;
      store(out + x, median | (here < Values{} ? Values{} + mark : Values{}));
    }
    out[0] = row[0];
    out[width - 1] = row[width - 1];
  }

  static void guide(const std::uint8_t* row, const std::uint8_t* next, const std::uint8_t* after, int width,
                    std::uint8_t* out) {
    constexpr int kAcrossShift = 8;
    for (int x = 0; x < width; x += V::kBytes) {
      const Pixels here = load_pixels(row + x);
      const Pixels across =
          guide_bits<kAcrossShift>(here, load_pixels(row + x - 1), load_pixels(row + x + 1));
      const Pixels down = guide_bits<kDownShift>(load_pixels(next + x), here, load_pixels(after + x));
      const Pixels both = across | down;
      __builtin_memcpy(out + x, &both, sizeof(both));
    }
  }

  static void upsample_columns(SubsampledDisparity* row, int image_width, const std::uint8_t* guide,
                               SubsampledDisparity* out) {
    const int width = (image_width + 1) / 2;
    row[width] = row[width - 1];
    for (int x = 0; x < width; x += kColumns) {
      const Values here = load(row + x);
      const Values odd_columns = load(guide + 2 * x);  // in the upper bytes
      const Values next = interpolate(here, load(row + x + 1), odd_columns);
      if constexpr (kColumns == 8) {
        store(out + 2 * x, __builtin_shufflevector(here, next, 0, 8, 1, 9, 2, 10, 3, 11));
        store(out + 2 * x + 8, __builtin_shufflevector(here, next, 4, 12, 5, 13, 6, 14, 7, 15));
      } else {
        store(out + 2 * x,
              __builtin_shufflevector(here, next, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
        store(out + 2 * x + 16, __builtin_shufflevector(here, next, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13,
                                                        29, 14, 30, 15, 31));
      }
    }
  }

  static void interpolate_rows(const SubsampledDisparity* a, const SubsampledDisparity* b, int width,
                               const std::uint8_t* guide, SubsampledDisparity* out) {
    for (int x = 0; x < width; x += kColumns) {
      store(out + x, interpolate(load(a + x), load(b + x), load_bytes(guide + x) << kDownShift));
    }
  }

  static void write_disparities(const SubsampledDisparity* row, int width, const OutputParams& params,
                                std::int16_t* out) {
    const auto first =
        static_cast<SubsampledDisparity>(params.min_disparity * (params.subpixel ? kUnits : 1));
    const auto unmatched = static_cast<SubsampledDisparity>(params.fill ? 1 : kNoDisparity);
    const auto rounding = static_cast<SubsampledDisparity>(params.subpixel ? 0 : kUnits / 2);
    const int shift = params.subpixel ? 0 : 4;
    const auto to_output = [=](Values value, Values units) {
      const Values disparity = ((units + rounding) >> shift) + first;
      const Values marked = (value & 1) != 0 ? -2 - disparity : disparity;
      return value < 0 ? Values{} + static_cast<SubsampledDisparity>(kInvalidDisparity) : marked;
    };
    const Values lanes = ascending();
    // A match outside the right image makes the disparity unmeasured. Only the first columns can have one.
    const int border_end = params.min_disparity + params.disparities;
    int x = 0;
    for (; x < width && x < border_end; x += kColumns) {
      const Values value = load(row + x);
      const Values units = value >> 1;
      const Values match = lanes + static_cast<SubsampledDisparity>(x - params.min_disparity);
      const Values outside = match < ((units + kUnits / 2) >> 4);
      store(out + x, to_output(value | (outside & unmatched), units));
    }
    for (; x < width; x += kColumns) {
      const Values value = load(row + x);
      store(out + x, to_output(value, value >> 1));
    }
  }

  static void adapt_p2(const std::uint8_t* gray, int width, int step, int p2, std::uint8_t* out) {
    const auto maximum = static_cast<SubsampledDisparity>(p2);
    for (int x = 0; x < width; x += kColumns) {
      const Values change = load_samples(gray, x, step) - load_samples(gray, x - 1, step);
      const Values reduced = maximum - greater(change, -change);
      const Bytes bytes = __builtin_convertvector(greater(reduced, Values{}), Bytes);
      __builtin_memcpy(out + x, &bytes, sizeof(bytes));
    }
  }

 private:
  static constexpr int kUnits = kSubpixelUnits;
  static constexpr SubsampledDisparity kNear = kUnits * 3 / 2;
  static constexpr SubsampledDisparity kClose = kUnits / 2;

  // Bits of the guide, in the place where interpolate() wants them: the pixel between two others resembles
  // the second one more (kNotFirst) or the first one (kNotSecond). No disparity reaches these bits. A byte of
  // guide() holds them twice, shifted right by different numbers of bits: for its own row and for the next
  // one.
  static constexpr SubsampledDisparity kNotFirst = 0x4000, kNotSecond = 0x2000;
  static constexpr int kDownShift = 10;

  using Ints = typename VectorTypes<V::kBytes>::Ints;
  using Reals = typename VectorTypes<V::kBytes>::Reals;

  static Values load(const void* p) {
    Values values;
    __builtin_memcpy(&values, p, sizeof(values));
    return values;
  }
  static void store(void* p, Values values) { __builtin_memcpy(p, &values, sizeof(values)); }

  static Values load_bytes(const std::uint8_t* p) {
    Bytes bytes;
    __builtin_memcpy(&bytes, p, sizeof(bytes));
    return __builtin_convertvector(bytes, Values);
  }

  static Values ascending() {
    Values lanes{};
    for (int i = 0; i < kColumns; ++i) lanes[i] = static_cast<SubsampledDisparity>(i);
    return lanes;
  }

  // Returns ⌊8 · slope / curvature + 1/2⌋; |slope| ≤ curvature.
  static Values vertex(Values slope, Values curvature) {
    const Values divisor = curvature > Values{} ? curvature : Values{} + SubsampledDisparity{1};
    const Values lower = vertex_of_ints(lower_ints(slope), lower_ints(divisor));
    const Values upper = vertex_of_ints(upper_ints(slope), upper_ints(divisor));
    if constexpr (kColumns == 8) {
      return __builtin_shufflevector(lower, upper, 0, 2, 4, 6, 8, 10, 12, 14);
    } else {
      return __builtin_shufflevector(lower, upper, 0, 2, 4, 6, 16, 18, 20, 22, 8, 10, 12, 14, 24, 26, 28, 30);
    }
  }

  // Exact: a quotient that is no multiple of 1/2 differs from the nearest one by more than a float's
  // rounding.
  static Values vertex_of_ints(Ints slope, Ints divisor) {
    const Reals quotient =
        __builtin_convertvector(8 * slope, Reals) / __builtin_convertvector(divisor, Reals);
    // Truncation rounds down only above 0.
    return reinterpret_cast<Values>(__builtin_convertvector(quotient + 8.5F, Ints) - 8);
  }

  // The lower and the upper half of each 16 bytes.
  static Ints lower_ints(Values v) {
    if constexpr (kColumns == 8) {
      return reinterpret_cast<Ints>(__builtin_shufflevector(v, v, 0, 0, 1, 1, 2, 2, 3, 3)) >> 16;
    } else {
      return reinterpret_cast<Ints>(
                 __builtin_shufflevector(v, v, 0, 0, 1, 1, 2, 2, 3, 3, 8, 8, 9, 9, 10, 10, 11, 11)) >>
             16;
    }
  }
  static Ints upper_ints(Values v) {
    if constexpr (kColumns == 8) {
      return reinterpret_cast<Ints>(__builtin_shufflevector(v, v, 4, 4, 5, 5, 6, 6, 7, 7)) >> 16;
    } else {
      return reinterpret_cast<Ints>(
                 __builtin_shufflevector(v, v, 4, 4, 5, 5, 6, 6, 7, 7, 12, 12, 13, 13, 14, 14, 15, 15)) >>
             16;
    }
  }

  static Values lesser(Values a, Values b) { return a < b ? a : b; }
  static Values greater(Values a, Values b) { return a < b ? b : a; }
  static Values middle(Values a, Values b, Values c) {
    return greater(lesser(a, b), lesser(greater(a, b), c));
  }

  // Three values of a column, sorted.
  struct Column {
    Values minimum, middle, maximum;
  };

  static Column sorted(Values a, Values b, Values c) {
    const Values low = lesser(a, b);
    const Values high = greater(a, b);
    return {lesser(low, c), greater(low, lesser(high, c)), greater(high, c)};
  }

  // Returns the median of three sorted columns: the middle one of the maximum of the minima, the median of
  // the middles and the minimum of the maxima.
  static Values median_of(const Column& a, const Column& b, const Column& c) {
    return middle(greater(greater(a.minimum, b.minimum), c.minimum), middle(a.middle, b.middle, c.middle),
                  lesser(lesser(a.maximum, b.maximum), c.maximum));
  }

  static Pixels load_pixels(const std::uint8_t* p) {
    Pixels pixels;
    __builtin_memcpy(&pixels, p, sizeof(pixels));
    return pixels;
  }

  static Pixels gray_step(Pixels a, Pixels b) { return (a < b ? b : a) - (a < b ? a : b); }

  template <int kShift>
  static Pixels guide_bits(Pixels middle, Pixels first, Pixels second) {
    const Pixels to_first = gray_step(middle, first);
    const Pixels to_second = gray_step(middle, second);
    const Pixels none{};
    return (to_second < to_first ? none + (kNotFirst >> kShift) : none) |
           (to_first < to_second ? none + (kNotSecond >> kShift) : none);
  }

  static Values interpolate(Values a, Values b, Values guide) {
    const Values a_units = a >> 1;
    const Values b_units = b >> 1;
    const Values step = a_units - b_units;
    const Values lower = lesser(a, b);
    const Values chosen = lesser(a | (guide & kNotFirst), b | (guide & kNotSecond));
    const Values average = ((a_units + b_units) >> 1) * 2 | ((a | b) & 1);
    const Values both = greater(step, -step) < Values{} + kNear ? average : chosen;
    return lower < Values{} ? greater(a, b) : both;
  }

  static Values load_samples(const std::uint8_t* gray, int x, int step) {
    if (step == 2) return load(gray + 2 * x) & 0xFF;
    return load_bytes(gray + x);
  }
};

}  // namespace stereod::semiglobal
