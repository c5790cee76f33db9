// SPDX-License-Identifier: BSD-3-Clause
// One worker: rectifies and matches a band of rows.
#pragma once

#include <cstdint>
#include <memory>

#include "core/match/band_matcher.h"
#include "daemon/capture/pair_queue.h"
#include "daemon/pipeline/camera_rectification.h"
#include "daemon/publish/frame_publisher.h"
#include "daemon/publish/published_pixels.h"

namespace stereod {

/// Rectifies and matches one band at a time and announces its rows to the publisher. Owns its matcher and
/// scratch memory; shares nothing with other workers.
class BandWorker {
 public:
  /// @p size is the size of the rectified image [px], @p wanted the columns of it that get disparities.
  BandWorker(const MatcherOptions& options, Size size, ColumnRange wanted);

  /// Input and output of a frame, common to its workers.
  struct Job {
    const LeasedPair& pair;
    const CameraRectification& left;
    const CameraRectification& right;
    OutputFrame& output;
    FramePublisher& publisher;
    GrayImage* left_image;  ///< receives the rectified left image; null: not wanted
    bool announce;          ///< false if a filter needs the whole frame before rows are final
  };

  /// Processes the rows of @p blocks. Rectification stays a few rows ahead of matching, so that the rows are
  /// still in the cache when they are matched.
  void run(const Job& job, RowRange blocks) noexcept;

  // Durations of the latest run() [ns].
  std::int64_t rectify_ns() const { return rectify_ns_; }
  std::int64_t match_ns() const { return match_ns_; }

 private:
  void rectify_rows(const Job& job, RowRange band, RowRange rows) noexcept;
  const std::uint8_t* rectify_row(const RectifyMap& map, const FrameLease& frame, int y,
                                  std::uint8_t* out) noexcept;
  void match_rows(const Job& job, RowRange rows) noexcept;

  const ColumnRange wanted_, matched_;
  GrayImage whole_row_;  // empty if all columns are matched
  std::unique_ptr<BandMatcher> matcher_;
  std::int64_t rectify_ns_ = 0, match_ns_ = 0;
  int next_block_ = 0;  // to be announced
};

}  // namespace stereod
