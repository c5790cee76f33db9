// The obstacle scan of each frame, on its way to the network.
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
#include "stereod/frame_t.hpp"
#include "stereod/planar_lidar_t.hpp"

namespace stereod {

/// frame_t's stop_reason.
enum class StopReason : std::int8_t { kNone = 0, kObstacle = 1, kWayUnknown = 2, kGroundUnknown = 3 };

/// Is shown the rows as they are sent, so that it costs no latency, and publishes PREFIX_SCAN when the frame
/// is complete. One thread's, the publisher's; allocates nothing after its construction.
class ScanPublisher {
 public:
  ScanPublisher(MessageBus& bus, const std::string& prefix, const ScanConfig& config,
                const ScanGeometry& camera);

  void add_row(int y, const std::int16_t* disparity) noexcept;
  /// Every row was shown: publishes, and fills in what the frame's message says of the scan. False if the
  /// network refused the message.
  bool finish(frame_t& frame) noexcept;

 private:
  static constexpr int kFitEvery = 30;     // frames, once the ground is known
  static constexpr double kFollows = 0.2;  // how much of a new fit is believed

  void follow(const std::optional<GroundPlane>& fitted) noexcept;
  bool fit_is_due() const { return fit_ && (!ground_known_ || frames_ % kFitEvery == 0); }

  MessageBus& bus_;
  const std::string channel_;
  ObstacleScan scan_;
  std::optional<GroundFit> fit_;
  bool ground_known_;
  std::int64_t frames_ = 0;
  std::int64_t spent_ns_ = 0;
  planar_lidar_t message_{};
  MessageEncoder encoder_;
};

/// What a scan needs to know of a daemon's camera.
ScanGeometry scan_geometry(const Calibration& calibration, const MatcherOptions& matcher);

}  // namespace stereod
