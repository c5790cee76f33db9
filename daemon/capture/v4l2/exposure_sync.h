// SPDX-License-Identifier: BSD-3-Clause
// Keeps the exposure of two cameras as the configuration asks for.
#pragma once

#include <cstdint>
#include <string>

#include "core/sync/pairing.h"
#include "daemon/capture/v4l2/camera_controls.h"
#include "daemon/capture/v4l2/v4l2_pair_state.h"

namespace stereod::v4l2 {

/// Sets the controls of one camera and keeps its exposure; used by that camera's thread. Matching compares
/// gray values, so both images should be exposed alike:
///
///   auto    each camera controls its own exposure.
///   follow  the left camera controls its own exposure; its values are copied to the right camera every 0.5
///           s.
///   lock    the left camera controls its own exposure for 2 s; then both cameras keep the values it found.
///
/// An exposure time or gain that the configuration names for both cameras is set at once and then left alone;
/// the other one of the two is still locked or followed. (With lock and follow, the configuration cannot name
/// either for one camera.) exposure_dynamic_framerate is switched off unless the configuration names it: it
/// halves the frame rate of one camera in dim light.
class ExposureSync {
 public:
  ExposureSync(V4l2PairState& pair, Side side, const V4l2Config& config)
      : pair_(pair), side_(side), config_(config) {}

  /// Returns true if the configured controls have changed since configure().
  bool is_outdated() const noexcept { return controls_number_ != pair_.controls_number(); }

  /// Sets the controls of a camera that was just opened or whose configured controls have changed. Controls
  /// that the configuration no longer names are set to their default values. Updates note().
  void configure(VideoDevice& device, std::int64_t now_ns);

  /// Copies or locks the exposure if that is due. Call between two frames. Returns true if note() has
  /// changed. Does not allocate.
  bool update(VideoDevice& device, std::int64_t now_ns) noexcept;

  /// Returns a "; "-separated list of controls that do not have the wanted values; empty if all do.
  std::string note() const;

  /// Returns the exposure time at configure() [ns]. Returns 0 if the camera does not report it, and with lock
  /// and follow: both cameras will have the same exposure, which is not known yet.
  std::int64_t exposure_ns() const noexcept { return exposure_ns_; }

 private:
  static constexpr std::int64_t kUpdatePeriod = 500'000'000;
  static constexpr std::int64_t kSettlingTime = 2'000'000'000;

  void adopt_configuration(CameraControls& controls);
  ControlValues configured_values() const;
  ExposureValues read(VideoDevice& device) noexcept;
  void apply(VideoDevice& device, const ExposureValues& values) noexcept;
  void share(const ExposureValues& values) noexcept;
  bool disable_auto_modes(VideoDevice& device) noexcept;
  bool differs(const ExposureValues& wanted) const noexcept;
  std::string difference() const;

  V4l2PairState& pair_;
  const Side side_;
  V4l2Config config_;
  int controls_number_ = 0;
  // Controls that the camera has and the configuration does not name.
  bool has_time_ = false, has_gain_ = false, has_time_mode_ = false, has_gain_mode_ = false;
  std::string control_problems_;  // of configure()
  std::int64_t next_update_ns_ = 0;
  std::int64_t settled_ns_ = 0;  // lock: when the left camera's values are taken
  std::int64_t exposure_ns_ = 0;
  std::optional<ExposureValues> applied_;
  ExposureValues actual_;
  bool manual_ = false;     // the automatic modes are off
  bool differing_ = false;  // the camera does not accept the values in applied_
};

}  // namespace stereod::v4l2
