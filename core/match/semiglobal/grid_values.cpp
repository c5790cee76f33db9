#include "core/match/semiglobal/grid_values.h"

#include <algorithm>

#include "core/eight_values.h"

namespace stereod::semiglobal {

void fill_grid_row(GridValue* row, int width) noexcept {
  for (int x = 0; x < width;) {
    if (x % kEight == 0 && x + kEight <= width && !any_of(load_eight(row + x) < EightValues{})) {
      x += kEight;
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

}  // namespace stereod::semiglobal
