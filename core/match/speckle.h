// SPDX-License-Identifier: BSD-3-Clause
// Removal of small regions, the only filter that needs the whole image.
#pragma once

#include <cstdint>
#include <vector>

#include "core/match/disparity.h"

namespace stereod {

/// Removes small regions of connected pixels (docs/matcher.md, section 5). Owns its scratch memory.
///
/// Each row is cut into runs of connected pixels; runs of neighboring rows that touch are united (union-find
/// over runs; Rosenfeld and Pfaltz 1966 label components in this way).
class SpeckleFilter {
 public:
  /// Allocates memory for images of size @p image [1…32767 px a side].
  explicit SpeckleFilter(Size image);
  /// Sets every region of at most @p max_size [px] to kInvalidDisparity. A region is connected up, down, left
  /// and right by steps of at most @p max_step [units]; filled pixels count with their disparity.
  void apply(ImageView<std::int16_t> disparity, int max_size, int max_step) noexcept;

 private:
  struct Run {
    std::int32_t parent;  // a run of the same region; itself if it is the root
    std::int32_t size;    // [px] of the region, if it is the root
    std::int16_t first, end;
  };

  static constexpr int kMarks = 8;  // tested in one load

  void cut_row(const std::int16_t* row, int max_step) noexcept;
  void mark_cuts(const std::int16_t* row, int max_step) noexcept;
  void join_rows(const std::int16_t* upper, const std::int16_t* lower, int y, int max_step) noexcept;
  std::int32_t root_of(std::int32_t run) noexcept;
  void unite(std::int32_t a, std::int32_t b) noexcept;

  Size size_;
  std::vector<Run> runs_;  // room for one a pixel; in reading order
  std::int32_t run_count_ = 0;
  std::vector<std::int32_t> row_first_run_;  // and one more entry for the end
  std::vector<std::uint8_t> cuts_;           // of one row, followed by zeros
};

}  // namespace stereod
