// Removal of small regions, the one filter that needs the whole image.
#pragma once

#include <cstdint>
#include <vector>

#include "core/match/disparity.h"

namespace stereod {

/// Makes invalid every region of at most `max_size` pixels; a region is what hangs together up, down, left
/// and right by steps of at most `max_step` units (docs/matcher.md, section 5). Owns its scratch memory.
///
/// Each row is cut into runs of pixels that hang together; runs of neighboring rows that touch are united
/// (union-find over runs; Rosenfeld and Pfaltz 1966 label components in this way).
class SpeckleFilter {
 public:
  /// For images of up to 32767 pixels a side.
  explicit SpeckleFilter(Size image);
  void apply(ImageView<std::int16_t> disparity, int max_size, int max_step) noexcept;

 private:
  struct Run {
    std::int32_t parent;  // a run of the same region; itself if it stands for the region
    std::int32_t size;    // pixels of the region, if it stands for it
    std::int16_t first, end;
  };

  static constexpr int kMarks = 8;  // looked at in one go

  void cut_row(const std::int16_t* row, int max_step) noexcept;
  void mark_cuts(const std::int16_t* row, int max_step) noexcept;
  void join_rows(const std::int16_t* upper, const std::int16_t* lower, int y, int max_step) noexcept;
  std::int32_t root_of(std::int32_t run) noexcept;
  void unite(std::int32_t a, std::int32_t b) noexcept;

  Size size_;
  std::vector<Run> runs_;  // room for as many as there are pixels; in reading order
  std::int32_t run_count_ = 0;
  std::vector<std::int32_t> row_first_run_;  // and one entry for the end
  std::vector<std::uint8_t> cuts_;           // of one row, and zeros after it
};

}  // namespace stereod
