// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/subsampled_disparity.h"

#include <algorithm>

#include "core/base/simd_i16x8.h"

namespace stereod::semiglobal {

void fill_holes(SubsampledDisparity* row, int width) noexcept {
  for (int x = 0; x < width;) {
    if (x % kI16Lanes == 0 && x + kI16Lanes <= width && !any_of(load_i16x8(row + x) < I16x8{})) {
      x += kI16Lanes;
      continue;
    }
    if (row[x] >= 0) {
      ++x;
      continue;
    }
    int end = x;
    while (end < width && row[end] < 0) ++end;
    const SubsampledDisparity left = x > 0 ? row[x - 1] : kNoDisparity;
    const SubsampledDisparity right = end < width ? row[end] : kNoDisparity;
    const SubsampledDisparity value = left < 0 ? right : right < 0 ? left : std::min(left, right);
    std::fill(row + x, row + end, static_cast<SubsampledDisparity>(value | 1));
    x = end;
  }
}

}  // namespace stereod::semiglobal
