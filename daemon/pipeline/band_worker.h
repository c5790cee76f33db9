// One worker: from two buffers of a camera to final disparity rows.
#pragma once

#include <cstdint>
#include <memory>

#include "core/match/band_matcher.h"
#include "core/rectify/rectify_map.h"
#include "daemon/capture/pair_queue.h"
#include "daemon/publish/frame_publisher.h"
#include "daemon/publish/published_pixels.h"

namespace stereod {

/// Rectifies, matches and hands over one band at a time. Owns its matcher; shares nothing with other workers.
class BandWorker {
 public:
  /// `size`: of the rectified image; `wanted`: the columns of it that get disparities.
  BandWorker(const MatcherOptions& options, Size size, ColumnRange wanted);

  /// What a frame's workers have in common.
  struct Job {
    const LeasedPair& pair;
    const RectifyMap& left_map;
    const RectifyMap& right_map;
    const ValidityMask& left_mask;  ///< of the columns that are matched; the right one likewise
    const ValidityMask& right_mask;
    OutputFrame& output;
    FramePublisher& publisher;
    GrayImage* left_image;  ///< gets the rectified left image; null: nobody wants it
    bool announce;  ///< rows are final once they are matched; false if a filter waits for the whole frame
  };

  /// Does the rows of `blocks`. Rectification goes a few rows ahead of matching, so that the rows are still
  /// in the cache when they are matched.
  void run(const Job& job, RowRange blocks) noexcept;

  /// Time the last run() spent, ns.
  std::int64_t rectify_ns() const { return rectify_ns_; }
  std::int64_t match_ns() const { return match_ns_; }

 private:
  void rectify_rows(const Job& job, RowRange band, RowRange rows) noexcept;
  const std::uint8_t* rectify_row(const RectifyMap& map, const FrameLease& frame, int y,
                                  std::uint8_t* out) noexcept;
  void match_rows(const Job& job, RowRange rows) noexcept;

  const ColumnRange wanted_, matched_;
  GrayImage whole_row_;  // if less than that is matched
  std::unique_ptr<BandMatcher> matcher_;
  std::int64_t rectify_ns_ = 0, match_ns_ = 0;
  int next_block_ = 0;  // the next one to be announced
};

}  // namespace stereod
