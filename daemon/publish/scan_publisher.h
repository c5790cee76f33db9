// SPDX-License-Identifier: BSD-3-Clause
// The output PREFIX_SCAN: the obstacle scan of each frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/geometry/calibration.h"
#include "core/perception/ground_plane.h"
#include "core/perception/obstacle_scan.h"
#include "daemon/config/config.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "daemon/publish/row_consumer.h"
#include "stereod/planar_lidar_t.hpp"

namespace stereod {

/// Scans the rows while they are sent, so that the scan adds no latency to them, and publishes planar_lidar_t
/// at the end of each frame. Estimates the ground plane if the configuration says so: until it is known,
/// nothing is published and the summary says stop, unless no stop distance is configured. Used by the
/// publisher thread only; allocates nothing after construction.
class ScanPublisher final : public RowConsumer {
 public:
  ScanPublisher(MessageBus& bus, const std::string& prefix, const ScanConfig& config,
                const ScanGeometry& camera);

  void take_rows(const FinalRows& rows) noexcept override;
  /// Publishes the scan. Returns its summary, always.
  std::optional<ScanSummary> end_rows(const FrameTiming& timing) noexcept override;
  std::int64_t refused() const noexcept override { return refused_; }

 private:
  static constexpr int kFramesPerFit = 30;   // once the ground is known
  static constexpr double kFitWeight = 0.2;  // of a new fit against the ground so far

  void publish(const ScanResult& result, std::int64_t utime) noexcept;
  void follow(const std::optional<GroundPlane>& fitted) noexcept;
  bool fit_is_due() const { return fit_ && (!ground_known_ || frames_ % kFramesPerFit == 0); }

  MessageBus& bus_;
  const std::string channel_;
  ObstacleScan scan_;
  std::optional<GroundFit> fit_;
  bool ground_known_;
  const bool stop_wanted_;  // a stop distance is configured
  std::int64_t frames_ = 0;
  std::int64_t spent_ns_ = 0;  // on the present frame
  std::int64_t refused_ = 0;
  planar_lidar_t message_{};
  MessageEncoder encoder_;
};

/// Returns what a scan needs to know of the rectified cameras.
ScanGeometry scan_geometry(const Calibration& calibration, const MatcherOptions& matcher);

}  // namespace stereod
