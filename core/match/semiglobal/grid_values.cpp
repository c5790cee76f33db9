#include "core/match/semiglobal/grid_values.h"

#include <algorithm>

#include "core/disparity.h"
#include "core/eight_values.h"

namespace stereod::semiglobal {
namespace {

using Values = EightValues;
constexpr int kColumns = kEight;
static_assert(2 * kColumns <= kValueMargin);

Values load(const GridValue* p) { return load_eight(p); }
void store(GridValue* p, Values values) { store_eight(p, values); }

Values lesser(Values a, Values b) { return a < b ? a : b; }
Values greater(Values a, Values b) { return a < b ? b : a; }
Values middle(Values a, Values b, Values c) { return greater(lesser(a, b), lesser(greater(a, b), c)); }

// Three values one above the other, sorted.
struct Column {
  Values least, middle, most;
};

Column sorted(Values a, Values b, Values c) {
  const Values low = lesser(a, b);
  const Values high = greater(a, b);
  return {lesser(low, c), greater(low, lesser(high, c)), greater(high, c)};
}

// The median of sorted columns: it is the middle of the greatest of the least ones, the median of the middle
// ones and the least of the greatest ones.
Values median(const Column& a, const Column& b, const Column& c) {
  return middle(greater(greater(a.least, b.least), c.least), middle(a.middle, b.middle, c.middle),
                lesser(lesser(a.most, b.most), c.most));
}

Values between(Values a, Values b) {
  constexpr GridValue kNear = kSubpixelUnits * 3 / 2;
  const Values a_units = a >> 1;
  const Values b_units = b >> 1;
  const Values step = a_units - b_units;
  const Values least = lesser(a, b);
  const Values average = ((a_units + b_units) >> 1) * 2 | ((a | b) & 1);
  const Values both = greater(step, -step) < Values{} + kNear ? average : least;
  return least < Values{} ? greater(a, b) : both;
}

}  // namespace

void median_grid_row(const GridValue* above, const GridValue* row, const GridValue* below, int width,
                     bool fill, GridValue* out) noexcept {
  const auto filled = static_cast<GridValue>(fill ? 1 : kNone);  // what is set in values that were not there
  const auto column = [&](int x) { return sorted(load(above + x), load(row + x), load(below + x)); };
  for (int x = 0; x < width; x += kColumns) {
    const Values here = load(row + x);
    const Values found = median(column(x - 1), column(x), column(x + 1));
    store(out + x, found | (here < Values{} ? Values{} + filled : Values{}));
  }
  out[0] = row[0];
  out[width - 1] = row[width - 1];
}

void fill_grid_row(GridValue* row, int width) noexcept {
  for (int x = 0; x < width;) {
    if (x % kColumns == 0 && x + kColumns <= width && !any_of(load(row + x) < Values{})) {
      x += kColumns;
      continue;
    }
    if (row[x] >= 0) {
      ++x;
      continue;
    }
    int end = x;
    while (end < width && row[end] < 0) ++end;
    const GridValue left = x > 0 ? row[x - 1] : kNone;
    const GridValue right = end < width ? row[end] : kNone;
    const GridValue value = left < 0 ? right : right < 0 ? left : std::min(left, right);
    std::fill(row + x, row + end, static_cast<GridValue>(value | 1));
    x = end;
  }
}

void widen_grid_row(GridValue* row, int image_width, GridValue* out) noexcept {
  const int width = (image_width + 1) / 2;
  row[width] = row[width - 1];
  for (int x = 0; x < width; x += kColumns) {
    const Values here = load(row + x);
    const Values next = between(here, load(row + x + 1));
    store(out + 2 * x, __builtin_shufflevector(here, next, 0, 8, 1, 9, 2, 10, 3, 11));
    store(out + 2 * x + kColumns, __builtin_shufflevector(here, next, 4, 12, 5, 13, 6, 14, 7, 15));
  }
}

void between_rows(const GridValue* a, const GridValue* b, int width, GridValue* out) noexcept {
  for (int x = 0; x < width; x += kColumns) store(out + x, between(load(a + x), load(b + x)));
}

void disparities_of_row(const GridValue* row, int width, const Disparities& what,
                        std::int16_t* out) noexcept {
  const auto first = static_cast<GridValue>(what.min_disparity * (what.subpixel ? int{kSubpixelUnits} : 1));
  const auto unmatched = static_cast<GridValue>(what.fill ? 1 : kNone);
  const auto rounding = static_cast<GridValue>(what.subpixel ? 0 : kSubpixelUnits / 2);
  const int shift = what.subpixel ? 0 : 4;
  const auto finished = [=](Values judged, Values units) {
    const Values disparity = ((units + rounding) >> shift) + first;
    const Values marked = (judged & 1) != 0 ? -2 - disparity : disparity;
    return judged < 0 ? Values{} + kInvalidDisparity : marked;
  };
  const Values column = {0, 1, 2, 3, 4, 5, 6, 7};
  int x = 0;
  // Measured, but outside the right picture: that is no measurement. Further right it cannot be.
  for (; x < std::min(width, what.min_disparity + what.disparities); x += kColumns) {
    const Values value = load(row + x);
    const Values units = value >> 1;
    const Values match = column + static_cast<GridValue>(x - what.min_disparity);
    const Values outside = match < ((units + kSubpixelUnits / 2) >> 4);
    store(out + x, finished(value | (outside & unmatched), units));
  }
  for (; x < width; x += kColumns) {
    const Values value = load(row + x);
    store(out + x, finished(value, value >> 1));
  }
}

void step_limits(const std::uint8_t* grey, int width, int step, int p2, std::uint8_t* limits) noexcept {
  const auto most = static_cast<GridValue>(p2);
  const auto points = [&](int x) {
    if (step == 2) return load(reinterpret_cast<const GridValue*>(grey + 2 * x)) & 0xFF;
    return load_eight(grey + x);
  };
  for (int x = 0; x < width; x += kColumns) {
    const Values change = points(x) - points(x - 1);
    const Values left_over = most - greater(change, -change);
    store_eight(limits + x, greater(left_over, Values{}));
  }
}

}  // namespace stereod::semiglobal
