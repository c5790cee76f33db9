// SPDX-License-Identifier: BSD-3-Clause
// The state of the daemon and its cause.
#pragma once

#include <string>
#include <string_view>

#include "daemon/pipeline/calibration_monitor.h"

namespace stereod {

/// status_t's state.
enum class ServiceState { kStarting, kWaitingForCameras, kUncalibrated, kStreaming, kDegraded };
/// Returns the name on the wire, for example "waiting_for_cameras".
std::string_view name_of(ServiceState state);

/// Why the state is not kStreaming.
enum class StateCause {
  kNone,
  kNoFramesYet,
  kNoFrames,       ///< from either camera
  kNoLeftFrames,   ///< but from the right camera
  kNoRightFrames,  ///< but from the left camera
  kNoPairs,        ///< frames, but too far apart in time
  kNotPublished,   ///< pairs, but no frame was published
  kRefused,        ///< the network refused messages
  kUncalibrated,
  kMisaligned,  ///< CalibrationFit::kMisaligned
  kNoMatches,   ///< CalibrationFit::kNoMatches
};

/// A state and its cause. The log has a line for each change.
struct ServiceCondition {
  ServiceState state = ServiceState::kStarting;
  StateCause cause = StateCause::kNoFramesYet;
  friend bool operator==(const ServiceCondition&, const ServiceCondition&) = default;
};

/// What happened recently.
struct Activity {
  bool left_frames = false, right_frames = false;
  bool pairs = false;
  bool published = false;
  bool refused = false;  ///< the network refused messages
  CalibrationFit fit = CalibrationFit::kGood;
};

/// Returns the state of a daemon that has started; the cause nearest to the cameras counts.
ServiceCondition judge_state(const Activity& activity, bool calibrated);

/// Returns the reason for status_t: what is wrong and what to do; empty for kNone. @p epipolar are the
/// statistics that a lost calibration was found by.
std::string describe(StateCause cause, const EpipolarStats& epipolar = {});

}  // namespace stereod
