// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/service_state.h"

#include "core/base/enum_names.h"

namespace stereod {
namespace {

constexpr EnumNames<ServiceState, 5> kStateNames{{{ServiceState::kStarting, "starting"},
                                                  {ServiceState::kWaitingForCameras, "waiting_for_cameras"},
                                                  {ServiceState::kUncalibrated, "uncalibrated"},
                                                  {ServiceState::kStreaming, "streaming"},
                                                  {ServiceState::kDegraded, "degraded"}}};

StateCause missing_frames(const Activity& activity) {
  if (activity.left_frames && activity.right_frames) return StateCause::kNone;
  if (activity.left_frames) return StateCause::kNoRightFrames;
  if (activity.right_frames) return StateCause::kNoLeftFrames;
  return StateCause::kNoFrames;
}

}  // namespace

std::string_view name_of(ServiceState state) { return find_name(kStateNames, state); }

ServiceCondition judge_state(const Activity& activity, bool calibrated) {
  if (const StateCause missing = missing_frames(activity); missing != StateCause::kNone) {
    return {ServiceState::kWaitingForCameras, missing};
  }
  if (!activity.published) {
    return {ServiceState::kDegraded, activity.pairs ? StateCause::kNotPublished : StateCause::kNoPairs};
  }
  if (activity.refused) return {ServiceState::kDegraded, StateCause::kRefused};
  if (!calibrated) return {ServiceState::kUncalibrated, StateCause::kUncalibrated};
  if (calibration_lost(activity.fit)) {
    return {ServiceState::kDegraded,
            activity.fit == CalibrationFit::kMisaligned ? StateCause::kMisaligned : StateCause::kNoMatches};
  }
  return {ServiceState::kStreaming, StateCause::kNone};
}

std::string describe(StateCause cause, const EpipolarStats& epipolar) {
  switch (cause) {
    case StateCause::kNone:
      return {};
    case StateCause::kNoFramesYet:
      return "waiting for the first frames";
    case StateCause::kNoFrames:
      return "no frames from either camera";
    case StateCause::kNoLeftFrames:
      return "no frames from the left camera";
    case StateCause::kNoRightFrames:
      return "no frames from the right camera";
    case StateCause::kNoPairs:
      return "both cameras deliver frames, but never two close enough in time for a pair: raise cameras.max_skew_ms or "
             "set the same frame rate on both";
    case StateCause::kNotPublished:
      return "pairs arrive, but no frame was published recently";
    case StateCause::kRefused:
      return "the network refused messages";
    case StateCause::kUncalibrated:
      return "no calibration is configured, images are matched unrectified";
    case StateCause::kMisaligned:
      return describe(CalibrationFit::kMisaligned, epipolar);
    case StateCause::kNoMatches:
      return describe(CalibrationFit::kNoMatches, epipolar);
  }
  return {};
}

}  // namespace stereod
