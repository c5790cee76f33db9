// Rows of values on the grid, a vector of them at a time, in the compiler's own vectors.
#pragma once

#include <cstdint>

#include "core/match/semiglobal/kernels/kernel.h"

namespace stereod::semiglobal {

/// The compiler's vectors of so many bytes; of Bytes as many as of Values, of Pixels twice as many.
template <int kBytes>
struct VectorTypes;

template <>
struct VectorTypes<16> {
  using Values [[gnu::vector_size(16)]] = GridValue;
  using Ints [[gnu::vector_size(16)]] = std::int32_t;
  using Reals [[gnu::vector_size(16)]] = float;
  using Bytes [[gnu::vector_size(8)]] = std::uint8_t;
  using Pixels [[gnu::vector_size(16)]] = std::uint8_t;
};

template <>
struct VectorTypes<32> {
  using Values [[gnu::vector_size(32)]] = GridValue;
  using Ints [[gnu::vector_size(32)]] = std::int32_t;
  using Reals [[gnu::vector_size(32)]] = float;
  using Bytes [[gnu::vector_size(16)]] = std::uint8_t;
  using Pixels [[gnu::vector_size(32)]] = std::uint8_t;
};

/// Kernel::interpolate_row and the functions of the kernel that follow it.
template <typename V>
class GridRows {
  static constexpr int kColumns = V::kBytes / 2;
  using Values = typename VectorTypes<V::kBytes>::Values;  // a comparison gives −1 where it holds
  using Bytes = typename VectorTypes<V::kBytes>::Bytes;
  using Pixels = typename VectorTypes<V::kBytes>::Pixels;
  static_assert(2 * kColumns <= kValueMargin, "the median looks at the vectors before and after");

 public:
  static void interpolate(const Shape& shape, const WinnerRow& winners, GridValue* out) {
    constexpr int kFar = 20'000;  // columns; no disparity is as large
    const int width = shape.grid_width();
    const Values lanes = ascending() * static_cast<GridValue>(shape.decimation_x);
    for (int x = 0; x < width; x += kColumns) {
      const Values k = load_bytes(winners.index + x);
      const Values least = load(winners.winners + x) >> 8 & GridValue{0xFF};
      const Values before = load_bytes(winners.sum_before + x);
      const Values after = load_bytes(winners.sum_after + x);
      const Values sixteenths = 16 * k + part(before - after, before + after - 2 * least);
      const int column = x * shape.decimation_x - shape.min_disparity;
      const auto first = static_cast<GridValue>(column < kFar ? column : kFar);
      const Values match = lanes + first - k;
      store(out + x, 2 * sixteenths | (match < Values{}));  // kNone: all bits
    }
  }

  static void median(const GridValue* above, const GridValue* row, const GridValue* below, int width,
                     bool fill, GridValue* out) {
    const auto filled =
        static_cast<GridValue>(fill ? 1 : kNone);  // what is set in values that were not there
    for (int x = 0; x < width; x += kColumns) {
      const auto column = [&](int at) { return sorted(load(above + at), load(row + at), load(below + at)); };
      const Values here = load(row + x);
      const Column own = column(x);
      const Values of_nine = median_of(column(x - 1), own, column(x + 1));
      // Of something thin and upright: kNone is too far from what is that near to be close to it.
      const Values to_next = lesser(own.most - own.middle, own.middle - own.least);
      const Values thin = (own.middle > of_nine + 2 * kNear) & (to_next < Values{} + 2 * kClose);
      const Values found = thin < Values{} ? own.middle : of_nine;
      store(out + x, found | (here < Values{} ? Values{} + filled : Values{}));
    }
    out[0] = row[0];
    out[width - 1] = row[width - 1];
  }

  static void likeness(const std::uint8_t* row, const std::uint8_t* next, const std::uint8_t* after,
                       int width, std::uint8_t* out) {
    constexpr int kAcrossShift = 8;
    for (int x = 0; x < width; x += V::kBytes) {
      const Pixels here = load_pixels(row + x);
      const Pixels across = unlike<kAcrossShift>(here, load_pixels(row + x - 1), load_pixels(row + x + 1));
      const Pixels down = unlike<kDownShift>(load_pixels(next + x), here, load_pixels(after + x));
      const Pixels both = across | down;
      __builtin_memcpy(out + x, &both, sizeof(both));
    }
  }

  static void widen(GridValue* row, int image_width, const std::uint8_t* likeness, GridValue* out) {
    const int width = (image_width + 1) / 2;
    row[width] = row[width - 1];
    for (int x = 0; x < width; x += kColumns) {
      const Values here = load(row + x);
      const Values odd_columns = load(likeness + 2 * x);  // in the upper bytes
      const Values next = between_two(here, load(row + x + 1), odd_columns);
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

  static void between(const GridValue* a, const GridValue* b, int width, const std::uint8_t* likeness,
                      GridValue* out) {
    for (int x = 0; x < width; x += kColumns) {
      store(out + x, between_two(load(a + x), load(b + x), load_bytes(likeness + x) << kDownShift));
    }
  }

  static void disparities(const GridValue* row, int width, const Disparities& what, std::int16_t* out) {
    const auto first = static_cast<GridValue>(what.min_disparity * (what.subpixel ? kUnits : 1));
    const auto unmatched = static_cast<GridValue>(what.fill ? 1 : kNone);
    const auto rounding = static_cast<GridValue>(what.subpixel ? 0 : kUnits / 2);
    const int shift = what.subpixel ? 0 : 4;
    const auto finished = [=](Values judged, Values units) {
      const Values disparity = ((units + rounding) >> shift) + first;
      const Values marked = (judged & 1) != 0 ? -2 - disparity : disparity;
      return judged < 0 ? Values{} + static_cast<GridValue>(kInvalidDisparity) : marked;
    };
    const Values lanes = ascending();
    // Measured, but outside the right image: that is no measurement. Further right it cannot be.
    const int reach = what.min_disparity + what.disparities;
    int x = 0;
    for (; x < width && x < reach; x += kColumns) {
      const Values value = load(row + x);
      const Values units = value >> 1;
      const Values match = lanes + static_cast<GridValue>(x - what.min_disparity);
      const Values outside = match < ((units + kUnits / 2) >> 4);
      store(out + x, finished(value | (outside & unmatched), units));
    }
    for (; x < width; x += kColumns) {
      const Values value = load(row + x);
      store(out + x, finished(value, value >> 1));
    }
  }

  static void step_limits(const std::uint8_t* gray, int width, int step, int p2, std::uint8_t* limits) {
    const auto most = static_cast<GridValue>(p2);
    for (int x = 0; x < width; x += kColumns) {
      const Values change = points(gray, x, step) - points(gray, x - 1, step);
      const Values left_over = most - greater(change, -change);
      const Bytes bytes = __builtin_convertvector(greater(left_over, Values{}), Bytes);
      __builtin_memcpy(limits + x, &bytes, sizeof(bytes));
    }
  }

 private:
  static constexpr int kUnits = kSubpixelUnits;
  static constexpr GridValue kNear = kUnits * 3 / 2;
  static constexpr GridValue kClose = kUnits / 2;

  // Set with two values where a pixel between them does not look like the first or the second one. No value
  // reaches these bits. In a byte of likeness() they stand for the pixels of the row moved down by one number
  // of bits, for those of the next row by another.
  static constexpr GridValue kNotFirst = 0x4000, kNotSecond = 0x2000;
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
    for (int i = 0; i < kColumns; ++i) lanes[i] = static_cast<GridValue>(i);
    return lanes;
  }

  // ⌊8 · slope / curvature + 1/2⌋; |slope| ≤ curvature.
  static Values part(Values slope, Values curvature) {
    const Values divisor = curvature > Values{} ? curvature : Values{} + GridValue{1};
    const Values lower = part_of_ints(lower_ints(slope), lower_ints(divisor));
    const Values upper = part_of_ints(upper_ints(slope), upper_ints(divisor));
    if constexpr (kColumns == 8) {
      return __builtin_shufflevector(lower, upper, 0, 2, 4, 6, 8, 10, 12, 14);
    } else {
      return __builtin_shufflevector(lower, upper, 0, 2, 4, 6, 16, 18, 20, 22, 8, 10, 12, 14, 24, 26, 28, 30);
    }
  }

  // Exact: a quotient that is no multiple of 1/2 is further from the next one than a float's rounding.
  static Values part_of_ints(Ints slope, Ints divisor) {
    const Reals quotient =
        __builtin_convertvector(8 * slope, Reals) / __builtin_convertvector(divisor, Reals);
    // Above 0, where to cut off is to round.
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

  // Three values one above the other, sorted.
  struct Column {
    Values least, middle, most;
  };

  static Column sorted(Values a, Values b, Values c) {
    const Values low = lesser(a, b);
    const Values high = greater(a, b);
    return {lesser(low, c), greater(low, lesser(high, c)), greater(high, c)};
  }

  // The median of sorted columns: it is the middle of the greatest of the least ones, the median of the
  // middle ones and the least of the greatest ones.
  static Values median_of(const Column& a, const Column& b, const Column& c) {
    return middle(greater(greater(a.least, b.least), c.least), middle(a.middle, b.middle, c.middle),
                  lesser(lesser(a.most, b.most), c.most));
  }

  static Pixels load_pixels(const std::uint8_t* p) {
    Pixels pixels;
    __builtin_memcpy(&pixels, p, sizeof(pixels));
    return pixels;
  }

  static Pixels gray_step(Pixels a, Pixels b) { return (a < b ? b : a) - (a < b ? a : b); }

  template <int kShift>
  static Pixels unlike(Pixels middle, Pixels first, Pixels second) {
    const Pixels to_first = gray_step(middle, first);
    const Pixels to_second = gray_step(middle, second);
    const Pixels none{};
    return (to_second < to_first ? none + (kNotFirst >> kShift) : none) |
           (to_first < to_second ? none + (kNotSecond >> kShift) : none);
  }

  static Values between_two(Values a, Values b, Values likeness) {
    const Values a_units = a >> 1;
    const Values b_units = b >> 1;
    const Values step = a_units - b_units;
    const Values least = lesser(a, b);
    const Values liked = lesser(a | (likeness & kNotFirst), b | (likeness & kNotSecond));
    const Values average = ((a_units + b_units) >> 1) * 2 | ((a | b) & 1);
    const Values both = greater(step, -step) < Values{} + kNear ? average : liked;
    return least < Values{} ? greater(a, b) : both;
  }

  static Values points(const std::uint8_t* gray, int x, int step) {
    if (step == 2) return load(gray + 2 * x) & 0xFF;
    return load_bytes(gray + x);
  }
};

}  // namespace stereod::semiglobal
