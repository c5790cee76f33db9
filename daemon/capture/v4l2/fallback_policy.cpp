// SPDX-License-Identifier: BSD-3-Clause
// Requests format fallbacks.
#include "daemon/capture/v4l2/fallback_policy.h"

namespace stereod::v4l2 {
namespace {

constexpr int kMaxRefusedFormats = 3;
constexpr int kMaxSilentStarts = 2;

bool is_refused_format(const CameraFault& fault) {
  return fault.stage == SetupStage::kSetFormat &&
         (fault.reason == CameraReason::kOtherFormat || fault.reason == CameraReason::kNoFormat);
}

}  // namespace

std::optional<CameraFault> FallbackPolicy::level_change() const {
  const int common = pair_.fallback_level();
  if (common == level_) return std::nullopt;
  if (common > level_) {
    return CameraFault{
        CameraReason::kNoBandwidth, SetupStage::kSetFormat, 0,
        "restarting with less bandwidth, because the other camera does not get the bandwidth it needs"};
  }
  return CameraFault{CameraReason::kMoreBandwidth, SetupStage::kSetFormat, 0,
                     "restarting with the best format, because a camera has moved to another bus"};
}

void FallbackPolicy::setup_failed(CameraFault& fault) {
  if (fault.reason == CameraReason::kNoBandwidth) bandwidth_exceeded(fault);
  refused_formats_ = is_refused_format(fault) ? refused_formats_ + 1 : 0;
  if (refused_formats_ < kMaxRefusedFormats) return;
  refused_formats_ = 0;
  pair_.fall_back(side_, level_);
}

void FallbackPolicy::stream_failed(CameraFault& fault) {
  if (fault.reason == CameraReason::kNoBandwidth) bandwidth_exceeded(fault);
}

void FallbackPolicy::stream_silent(bool had_frame, CameraFault& fault) {
  const bool starved = !had_frame && pair_.may_lack_bandwidth(side_);
  silent_starts_ = starved ? silent_starts_ + 1 : 0;
  if (silent_starts_ >= kMaxSilentStarts) bandwidth_exceeded(fault);
}

void FallbackPolicy::bandwidth_exceeded(CameraFault& fault) {
  fault.reason = CameraReason::kNoBandwidth;
  fault.sentence = pair_.bandwidth_sentence(side_);
  // Without a further fallback the count is kept, so that every later silent start is attributed to the bus
  // too.
  if (!pair_.fall_back(side_, level_)) return;
  fault.sentence += "; falling back for both cameras";
  silent_starts_ = 0;
}

}  // namespace stereod::v4l2
