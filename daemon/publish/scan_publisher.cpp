// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/scan_publisher.h"

#include <algorithm>

#include "core/geometry/depth.h"
#include "daemon/base/clocks.h"
#include "daemon/lcm/limits.h"

namespace stereod {
namespace {

/// @p result is null while the ground is not known.
StopReason stop_reason(const ScanResult* result) {
  if (result == nullptr) return StopReason::kGroundUnknown;
  if (!result->stop) return StopReason::kNone;
  return result->nearest_m > 0 ? StopReason::kObstacle : StopReason::kWayUnknown;
}

}  // namespace

ScanPublisher::ScanPublisher(MessageBus& bus, const std::string& prefix, const ScanConfig& config,
                             const ScanGeometry& camera)
    : bus_(bus),
      channel_(prefix + "_SCAN"),
      scan_(config.options, camera, config.ground),
      ground_known_(!config.fit_ground),
      stop_wanted_(config.options.stop_distance_m > 0),
      encoder_(kMaxDatagram) {
  if (config.fit_ground) fit_.emplace(camera);
  message_.nranges = message_.nintensities = config.options.rays;
  message_.ranges.resize(static_cast<std::size_t>(config.options.rays));
  message_.intensities.resize(static_cast<std::size_t>(config.options.rays));
}

void ScanPublisher::take_rows(const FinalRows& rows) noexcept {
  const std::int64_t begin = monotonic_ns();
  const bool fit = fit_is_due();
  for (int y = rows.rectified.first; y < rows.rectified.end; ++y) {
    scan_.add_row(y, rows.disparity.row(y));
    if (fit) fit_->add_row(y, rows.disparity.row(y));
  }
  spent_ns_ += monotonic_ns() - begin;
}

std::optional<ScanSummary> ScanPublisher::end_rows(const FrameTiming& timing) noexcept {
  const std::int64_t begin = monotonic_ns();
  // A plane fitted to this frame counts from the next frame on.
  const bool ground_was_known = ground_known_;
  const ScanResult& result = scan_.finish();
  if (fit_is_due()) follow(fit_->finish());
  ++frames_;
  ScanSummary summary;
  if (stop_wanted_) summary.stop_reason = stop_reason(ground_was_known ? &result : nullptr);
  summary.stop = summary.stop_reason != StopReason::kNone;
  if (ground_was_known) {
    summary.nearest_m = result.nearest_m;
    publish(result, timing.utime);
  }
  summary.scan_us = static_cast<std::int32_t>((spent_ns_ + monotonic_ns() - begin) / 1000);
  spent_ns_ = 0;
  return summary;
}

void ScanPublisher::publish(const ScanResult& result, std::int64_t utime) noexcept {
  message_.utime = utime;
  std::copy(result.range_m.begin(), result.range_m.end(), message_.ranges.begin());
  std::copy(result.support.begin(), result.support.end(), message_.intensities.begin());
  message_.rad0 = result.first_rad;
  message_.radstep = result.step_rad;
  if (!encoder_.publish(bus_, channel_.c_str(), message_)) ++refused_;
}

void ScanPublisher::follow(const std::optional<GroundPlane>& fitted) noexcept {
  if (!fitted) return;
  GroundPlane ground = *fitted;
  if (ground_known_) {
    const GroundPlane& old = scan_.ground();
    ground.height_m = old.height_m + kFitWeight * (ground.height_m - old.height_m);
    ground.pitch_rad = old.pitch_rad + kFitWeight * (ground.pitch_rad - old.pitch_rad);
  }
  ground_known_ = true;
  scan_.set_ground(ground);
}

ScanGeometry scan_geometry(const Calibration& calibration, const MatcherOptions& matcher) {
  const RectifiedProjection& p = calibration.left.projection;
  ScanGeometry camera;
  camera.size = calibration.image;
  camera.fx = p.fx;
  camera.fy = p.fy;
  camera.cx = p.cx;
  camera.cy = p.cy;
  camera.baseline_m = calibration.baseline_m;
  camera.disparity_offset = disparity_offset_px(calibration);
  camera.units_per_pixel = matcher.units_per_pixel();
  camera.min_disparity = matcher.min_disparity;
  camera.disparities = matcher.disparities;
  return camera;
}

}  // namespace stereod
