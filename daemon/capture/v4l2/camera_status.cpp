// SPDX-License-Identifier: BSD-3-Clause
// State changes of a camera and their log lines.
#include "daemon/capture/v4l2/camera_status.h"

#include <utility>

namespace stereod::v4l2 {

CameraStatus::CameraStatus(Side side, CameraLog log) : side_(side), log_(std::move(log)) {
  fault_ = {CameraReason::kNotFound, SetupStage::kFind, 0, "the camera has not been searched for yet"};
}

CameraFault CameraStatus::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

bool CameraStatus::has_streamed() const {
  const std::lock_guard lock(mutex_);
  return has_streamed_;
}

void CameraStatus::fill(SourceReport& report) const {
  const std::lock_guard lock(mutex_);
  report.state = state_;
  report.reason = report.state == SourceState::kStreaming ? "" : fault_.sentence;
  report.device = device_;
  report.format = format_;
  report.note = note_;
  report.last_fault = last_fault_;
  report.last_fault_ns = last_fault_ns_;
  report.reconnects = reconnects_;
}

void CameraStatus::opened(std::string device, std::string format) {
  const std::lock_guard lock(mutex_);
  device_ = std::move(device);
  format_ = std::move(format);
  if (state_ == SourceState::kAbsent) state_ = SourceState::kOpening;
}

void CameraStatus::streaming() {
  const std::lock_guard lock(mutex_);
  if (has_streamed_) ++reconnects_;
  if (logged_ != CameraReason::kNone || !has_streamed_) {
    log(LogLevel::kInfo,
        std::string(has_streamed_ ? "streaming again: " : "streaming ") + format_ + " from " + device_);
  }
  has_streamed_ = true;
  logged_ = CameraReason::kNone;
  fault_ = {};
  state_ = SourceState::kStreaming;
}

void CameraStatus::failed(SourceState state, CameraFault fault, std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  const bool still_down = state_ == SourceState::kStalled || state_ == SourceState::kLost;
  if (!(still_down && state == SourceState::kOpening)) state_ = state;
  if (fault.reason != fault_.reason || last_fault_ns_ == 0) {
    last_fault_ = fault.sentence;
    last_fault_ns_ = now_ns;
  }
  fault_ = std::move(fault);
  if (fault_.reason == logged_) return;
  logged_ = fault_.reason;
  log(LogLevel::kWarning, std::string(name_of(state_)) + ": " + fault_.sentence);
}

void CameraStatus::set_note(const std::string& note) {
  const std::lock_guard lock(mutex_);
  if (note == note_) return;
  const bool already_logged =
      note_.find(note) != std::string::npos;  // only a part of the old note was withdrawn
  note_ = note;
  if (!already_logged) log(LogLevel::kWarning, note);
}

void CameraStatus::log(LogLevel level, const std::string& sentence) const {
  log_(level, (side_ == Side::kLeft ? "left camera: " : "right camera: ") + sentence);
}

}  // namespace stereod::v4l2
