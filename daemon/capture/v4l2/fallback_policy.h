// SPDX-License-Identifier: BSD-3-Clause
// Decides when a camera asks for the next format fallback.
#pragma once

#include <optional>

#include "core/sync/pairing.h"
#include "daemon/capture/v4l2/camera_fault.h"
#include "daemon/capture/v4l2/v4l2_pair_state.h"

namespace stereod::v4l2 {

/// Watches the failures of one camera; used by that camera's thread. Requests the next format fallback for
/// both cameras (V4l2PairState::fall_back()) when
///   - a call reports a full bus (ENOSPC),
///   - two starts in a row deliver no frame while the other camera has started on the same bus and the bus
///     has not yet carried both streams,
///   - the driver refuses, three times in a row, a format that it offers.
class FallbackPolicy {
 public:
  /// @p pair must outlive the policy.
  FallbackPolicy(V4l2PairState& pair, Side side) : pair_(pair), side_(side) {}

  /// Returns the level that the camera is set up with.
  int level() const noexcept { return level_; }
  /// Takes the cameras' common level for the next setup.
  void adopt_common_level() noexcept { level_ = pair_.fallback_level(); }
  /// Returns the reason to set the camera up again if the other camera has changed the common level, else
  /// nothing.
  std::optional<CameraFault> level_change() const;

  /// Judges a failed setup. Rewrites @p fault if the bus is full.
  void setup_failed(CameraFault& fault);
  /// Judges a stream that failed. Rewrites @p fault if the bus is full.
  void stream_failed(CameraFault& fault);
  /// Judges a stream without frames. @p had_frame: the stream had delivered one. Rewrites @p fault if the bus
  /// is full.
  void stream_silent(bool had_frame, CameraFault& fault);
  void streaming() noexcept { silent_starts_ = 0; }

 private:
  void bandwidth_exceeded(CameraFault& fault);

  V4l2PairState& pair_;
  const Side side_;
  int level_ = 0;
  int refused_formats_ = 0;  // in a row
  int silent_starts_ = 0;    // in a row, while the other camera had the bus
};

}  // namespace stereod::v4l2
