// SPDX-License-Identifier: BSD-3-Clause
// The interface of an output that is computed from disparity rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "daemon/publish/output_frame.h"
#include "daemon/publish/scan_summary.h"

namespace stereod {

/// Disparity rows that are final.
struct FinalRows {
  const FrameTiming& timing;
  DisparityView disparity;  ///< the whole rectified image; only `rectified` may be read
  RowRange published;       ///< rows of the published image
  RowRange rectified;  ///< the rows of the rectified image they cover, rows skipped by decimation included
};

/// Receives the disparity rows of every frame and sends messages made of them. To add an output, implement
/// this interface in one file and construct it in make_row_consumers().
///
/// For each frame FramePublisher calls, on its own thread and in this order: take_rows() for each block of
/// rows (the blocks cover the frame once, in any order), end_rows(), end_frame(). None of them may allocate
/// or wait for the matching threads.
class RowConsumer {
 public:
  virtual ~RowConsumer() = default;

  /// Receives rows whose disparity_rows_t was sent just before.
  virtual void take_rows(const FinalRows& rows) noexcept = 0;

  /// Receives the end of the frame's rows. Called before frame_t is sent, so it must be quick. Returns the
  /// obstacle scan's part of frame_t; outputs other than the scan return nothing.
  virtual std::optional<ScanSummary> end_rows(const FrameTiming& /*timing*/) noexcept { return std::nullopt; }

  /// Called after frame_t was sent: the place for large messages about the whole frame.
  virtual void end_frame(const FrameTiming& /*timing*/) noexcept {}

  /// Returns the bytes that take_rows() sends for @p rows published rows; pacing includes them. 0: sends
  /// nothing.
  virtual std::size_t bytes_for_rows(int /*rows*/) const noexcept { return 0; }

  /// Returns the bytes that the next end_frame() sends; pacing delays it accordingly.
  virtual std::size_t bytes_at_end() const noexcept { return 0; }

  /// Returns how many messages the network refused since construction.
  virtual std::int64_t refused() const noexcept = 0;
};

/// Consumers of one publisher, called in this order. They outlive it.
using RowConsumers = std::vector<std::reference_wrapper<RowConsumer>>;

}  // namespace stereod
