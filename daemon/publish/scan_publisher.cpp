#include "daemon/publish/scan_publisher.h"

#include <algorithm>

#include "core/geometry/depth.h"
#include "daemon/base/clocks.h"
#include "daemon/lcm/limits.h"

namespace stereod {

ScanPublisher::ScanPublisher(MessageBus& bus, const std::string& prefix, const ScanConfig& config,
                             const ScanGeometry& camera)
    : bus_(bus),
      channel_(prefix + "_SCAN"),
      scan_(config.options, camera, config.ground),
      ground_known_(!config.fit_ground),
      encoder_(kMaxDatagram) {
  if (config.fit_ground) fit_.emplace(camera);
  message_.nranges = message_.nintensities = config.options.rays;
  message_.ranges.resize(static_cast<std::size_t>(config.options.rays));
  message_.intensities.resize(static_cast<std::size_t>(config.options.rays));
}

void ScanPublisher::add_row(int y, const std::int16_t* disparity) noexcept {
  const std::int64_t begin = monotonic_ns();
  scan_.add_row(y, disparity);
  if (fit_is_due()) fit_->add_row(y, disparity);
  spent_ns_ += monotonic_ns() - begin;
}

bool ScanPublisher::finish(frame_t& frame) noexcept {
  const std::int64_t begin = monotonic_ns();
  const bool ground_was_known = ground_known_;
  const ScanResult& result = scan_.finish();
  if (fit_is_due()) follow(fit_->finish());
  ++frames_;
  bool sent = true;
  frame.nearest_m = ground_was_known ? result.nearest_m : 0;
  const StopReason reason = !ground_was_known      ? StopReason::kGroundUnknown
                            : !result.stop         ? StopReason::kNone
                            : result.nearest_m > 0 ? StopReason::kObstacle
                                                   : StopReason::kWayUnknown;
  frame.stop = static_cast<std::int8_t>(reason != StopReason::kNone ? 1 : 0);
  frame.stop_reason = static_cast<std::int8_t>(reason);
  if (ground_was_known) {
    message_.utime = frame.utime;
    std::copy(result.range_m.begin(), result.range_m.end(), message_.ranges.begin());
    std::copy(result.support.begin(), result.support.end(), message_.intensities.begin());
    message_.rad0 = result.first_rad;
    message_.radstep = result.step_rad;
    sent = encoder_.publish(bus_, channel_.c_str(), message_);
  }
  frame.scan_us = static_cast<std::int32_t>((spent_ns_ + monotonic_ns() - begin) / 1000);
  spent_ns_ = 0;
  return sent;
}

void ScanPublisher::follow(const std::optional<GroundPlane>& fitted) noexcept {
  if (!fitted) return;
  GroundPlane ground = *fitted;
  if (ground_known_) {
    const GroundPlane& old = scan_.ground();
    ground.height_m = old.height_m + kFollows * (ground.height_m - old.height_m);
    ground.pitch_rad = old.pitch_rad + kFollows * (ground.pitch_rad - old.pitch_rad);
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
