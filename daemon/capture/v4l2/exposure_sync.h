// Keeps two cameras' exposure as the configuration wants it.
#pragma once

#include <cstdint>
#include <string>

#include "core/sync/pairing.h"
#include "daemon/capture/v4l2/camera_controls.h"
#include "daemon/capture/v4l2/v4l2_pair_state.h"

namespace stereod {

/// One for each camera, used by its thread. Matching compares gray values, so both images should be exposed
/// alike:
///   auto    leaves each camera to itself;
///   follow  lets the left camera's automation work and copies what comes of it to the right one twice a
///   second; lock    lets the left camera's automation work for two seconds, then fixes both cameras to what
///   came of it
///           for good.
/// An exposure time or gain that the configuration names for both cameras is used at once and left alone; the
/// other one of the two is still locked or followed. (For one camera alone it may not be named with these
/// modes.) The automatic lengthening of frames in dim light (exposure_dynamic_framerate) is switched off
/// unless the configuration names it, because it halves the rate of one camera when it likes.
class ExposureSync {
 public:
  ExposureSync(V4l2PairState& pair, Side side, const V4l2Config& config)
      : pair_(pair), side_(side), config_(config) {}

  /// The pair's controls have changed since begin().
  bool outdated() const noexcept { return controls_number_ != pair_.controls_number(); }

  /// Sets a camera up that was just opened, or whose controls have changed: what the configuration names no
  /// more goes back to the camera's preset. note() then says what did not take.
  void begin(VideoDevice& device, std::int64_t now_ns);

  /// Does what is due, between two frames. Allocates nothing. True if note() has changed.
  bool tick(VideoDevice& device, std::int64_t now_ns) noexcept;
  /// What does not take now, in words.
  std::string note() const;

  /// The exposure time as it was at begin(), ns; 0 if the camera does not say, and with lock and follow: both
  /// cameras will have the same then.
  std::int64_t exposure_ns() const noexcept { return exposure_ns_; }

 private:
  static constexpr std::int64_t kPeriod = 500'000'000;
  static constexpr std::int64_t kSettle = 2'000'000'000;

  void take_controls(CameraControls& controls);
  ControlValues values() const;
  ExposureValues read(VideoDevice& device) noexcept;
  void fix(VideoDevice& device, const ExposureValues& values) noexcept;
  void offer(const ExposureValues& values) noexcept;
  bool go_manual(VideoDevice& device) noexcept;
  bool differs(const ExposureValues& wanted) const noexcept;
  std::string problem() const;

  V4l2PairState& pair_;
  const Side side_;
  V4l2Config config_;
  int controls_number_ = 0;
  // What it has and the configuration does not name.
  bool has_time_ = false, has_gain_ = false, has_time_mode_ = false, has_gain_mode_ = false;
  std::string complaints_;  // of begin()
  std::int64_t next_ns_ = 0;
  std::int64_t settled_ns_ = 0;
  std::int64_t exposure_ns_ = 0;
  std::optional<ExposureValues> applied_;
  ExposureValues got_;
  bool manual_ = false;  // the automatic modes have been switched off
  bool told_ = false;    // of a difference, which is still there
};

}  // namespace stereod
