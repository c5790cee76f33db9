// SPDX-License-Identifier: BSD-3-Clause
// Where the pixels of an image come from, as runs that are copied at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// Pixels [first, first + count) of a row, count ≤ kRunPixels, whose sources lie side by side. A lens moves
/// neighboring pixels together until the distance has changed by half a pixel or the row of the source
/// changes.
struct Run {
  std::int32_t source;  ///< [bytes from the first byte of the source] of the first pixel; below 0: no source
  std::uint16_t first;
  std::uint16_t count;
};
inline constexpr int kRunPixels = 16;

/// The runs of each row, 8 bytes a run. A row with more runs than half its pixels is stored as one offset a
/// pixel, which is smaller and faster then.
class RunTable {
 public:
  /// How a row is copied.
  enum class Kind : std::uint8_t {
    kWholeRuns,        ///< kRunPixels pixels for every run; the next run overwrites the excess
    kWholeRunsOrNone,  ///< the same, with runs that have no source
    kExactRuns,        ///< exactly the pixels of each run: the row reads near the end of the source
    kOffsets,          ///< each pixel for itself
  };
  struct Row {
    std::uint32_t begin;  ///< in the list of runs or of offsets
    Kind kind;
  };

  /// Makes an empty table for rows of @p width [1…kMaxWidth px]. @p ends are the columns, ascending, the last
  /// one @p width, where a segment ends that is copied by itself; no run crosses them. Whole runs are used
  /// only where the source has @p reach bytes from the first pixel of the run on, of @p source_bytes; never
  /// if @p reach is 0.
  RunTable(int width, std::vector<int> ends, std::ptrdiff_t pixel_stride, std::ptrdiff_t reach,
           std::ptrdiff_t source_bytes);
  static constexpr int kMaxWidth = 65'535;

  /// Appends a row, from the source of each of its `width` pixels [bytes; below 0: none].
  void append(const std::int32_t* offsets);

  const Row& row(int y) const { return rows_[static_cast<std::size_t>(y)]; }
  /// Returns the first run of @p row; the last run is followed by one that begins at the width.
  const Run* runs(const Row& row) const { return runs_.data() + row.begin; }
  const std::int32_t* offsets(const Row& row) const { return offsets_.data() + row.begin; }

  /// Returns the source of pixel (@p x, @p y) [bytes; below 0: none]. Searches the row.
  std::int32_t offset(int x, int y) const;

  std::size_t bytes() const;

 private:
  int width_;
  std::vector<int> ends_;
  std::ptrdiff_t pixel_stride_, reach_, source_bytes_;
  std::vector<Row> rows_;
  std::vector<Run> runs_;
  std::vector<std::int32_t> offsets_;
};

}  // namespace stereod
