// Which pixels of a image are moved where, so that many can be moved at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// Pixels [first, first + count) of a row whose sources lie one pixel after the other, at most kRunPixels of
/// them. Rectification moves pixels in such runs: a lens moves its neighbors together, until the distances
/// have grown by half a pixel or the row of the source changes.
struct Run {
  std::int32_t source;  ///< of the first pixel: bytes from the source's first one; below 0: there is none
  std::uint16_t first;
  std::uint16_t count;
};
inline constexpr int kRunPixels = 16;

/// For each row, the runs it is made of; 8 bytes a run. A row with more runs than half its pixels is kept as
/// one offset a pixel: that is smaller then, and faster.
class RunTable {
 public:
  /// How a row is moved.
  enum class Kind : std::uint8_t {
    kWholeRuns,        ///< kRunPixels at once, for every run; the next run overwrites what was too much
    kWholeRunsOrNone,  ///< the same, but some runs have no source
    kExactRuns,        ///< not a byte more than the run has: the row takes from the end of the source
    kOffsets,          ///< each pixel for itself
  };
  struct Row {
    std::uint32_t begin;  ///< in the list of runs or of offsets
    Kind kind;
  };

  /// For rows of `width` ≤ kMaxWidth pixels. No run goes across one of `ends`: the columns, growing, the last
  /// one being `width`, where a stretch of the row ends that is moved for itself. Whole runs are read only
  /// where the source has at least `reach` bytes from the run's first pixel on, of `source_bytes`; a reach of
  /// 0 means that they never are.
  RunTable(int width, std::vector<int> ends, std::ptrdiff_t pixel_stride, std::ptrdiff_t reach,
           std::ptrdiff_t source_bytes);
  static constexpr int kMaxWidth = 65'535;

  /// Appends a row: where each of its pixels comes from, below 0 for none.
  void append(const std::int32_t* offsets);

  const Row& row(int y) const { return rows_[static_cast<std::size_t>(y)]; }
  /// The row's first run; after its last one comes one that begins at the row's width.
  const Run* runs(const Row& row) const { return runs_.data() + row.begin; }
  const std::int32_t* offsets(const Row& row) const { return offsets_.data() + row.begin; }

  /// Where a pixel comes from, below 0 for nowhere.
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
