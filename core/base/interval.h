// SPDX-License-Identifier: BSD-3-Clause
// Half-open intervals of rows or columns, and how an image is cut into bands of rows.
#pragma once

#include <algorithm>

namespace stereod {

/// The half-open interval [first, end) of row or column numbers [px]. Empty if first ≥ end.
struct Interval {
  int first = 0;
  int end = 0;

  /// Returns the number of rows or columns; 0 or less if the interval is empty.
  int count() const { return end - first; }
  bool empty() const { return first >= end; }
  bool contains(int i) const { return i >= first && i < end; }

  friend bool operator==(const Interval&, const Interval&) = default;
};

/// What an interval counts, said where it is declared.
using RowRange = Interval;
using ColumnRange = Interval;

/// Returns @p interval with @p border rows more at both ends, clipped to @p limits. The result may be empty.
inline Interval grown(Interval interval, int border, Interval limits) {
  return {std::max(interval.first - border, limits.first), std::min(interval.end + border, limits.end)};
}

/// Returns the rows of band @p band [0…bands − 1] of an image of @p image_height rows that is cut into @p
/// bands [≥ 1] bands. Heights differ by at most one row; the first bands are the higher ones.
inline RowRange band_rows(int image_height, int band, int bands) {
  const int base = image_height / bands;
  const int rest = image_height % bands;
  const int first = band * base + std::min(band, rest);
  return {first, first + base + (band < rest ? 1 : 0)};
}

}  // namespace stereod
