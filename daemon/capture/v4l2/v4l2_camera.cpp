// SPDX-License-Identifier: BSD-3-Clause
// The lifecycle of one camera: closed, streaming, closing.
#include "daemon/capture/v4l2/v4l2_camera.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <utility>

namespace stereod::v4l2 {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kRetryDelay = 500 * kMs;  // after a failure
constexpr std::int64_t kSearchPeriod =
    1000 * kMs;  // for a missing camera, in case a device change was not reported
constexpr std::int64_t kConflictRetry =
    50 * kMs;  // while the other camera may be about to release its device
constexpr std::int64_t kLoanCheckPeriod = 10 * kMs;  // while closing
constexpr std::int64_t kMinStopTime = 2 * kMs;       // between stopping and starting a stream

// Rounds up, so that a wait does not end before its time.
std::chrono::milliseconds wait_ms(std::int64_t ns) {
  return std::chrono::milliseconds(std::max<std::int64_t>(0, ns) / kMs + 1);
}

std::string seconds_text(std::int64_t ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", static_cast<double>(ns) * 1e-9);
  return text;
}

}  // namespace

V4l2Camera::V4l2Camera(VideoSystem& system, std::shared_ptr<V4l2PairState> pair, Side side,
                       const CamerasConfig& config, CameraLog log)
    : system_(system),
      pair_(std::move(pair)),
      side_(side),
      config_(config),
      waiter_(system.make_waiter()),
      status_(side, std::move(log)),
      locator_(system, *pair_, side, side == Side::kLeft ? config.v4l2.left : config.v4l2.right),
      stream_(system, {config.v4l2.width, config.v4l2.height}),
      exposure_(*pair_, side, config.v4l2),
      fallback_(*pair_, side) {}

FrameLease V4l2Camera::next(std::chrono::milliseconds timeout) noexcept {
  const std::int64_t until_ns = system_.now_ns() + std::int64_t{timeout.count()} * kMs;
  do {
    if (stopping_) return {};
    try {
      if (FrameLease lease = run_once(until_ns)) return lease;
    } catch (const std::exception& error) {
      fail_without_memory(error);
    }
  } while (system_.now_ns() < until_ns);
  return {};
}

FrameLease V4l2Camera::run_once(std::int64_t until_ns) {
  switch (lifecycle_) {
    case Lifecycle::kClosed:
      if (system_.now_ns() < retry_ns_) {
        wait_for_device(until_ns);
      } else {
        set_up();
      }
      return {};
    case Lifecycle::kStreaming:
      return stream_once(until_ns);
    case Lifecycle::kClosing:
      close_when_returned(until_ns);
      return {};
  }
  return {};
}

void V4l2Camera::wait_for_device(std::int64_t until_ns) {
  const std::int64_t wait_ns = std::min(until_ns, retry_ns_) - system_.now_ns();
  if (waiter_->wait(-1, wait_ms(wait_ns)).devices_changed) retry_ns_ = 0;
}

void V4l2Camera::set_up() {
  std::optional<CameraFault> fault = locator_.locate(status_.has_streamed());
  if (!fault) fault = open_device();
  if (!fault) {
    configure_exposure();
    fault = start_stream();
  }
  if (fault) return setup_failed(std::move(*fault));
  lifecycle_ = Lifecycle::kStreaming;
  const StreamInfo& info = stream_.info();
  status_.opened(locator_.node() + " (" + info.device.card + ", " + info.device.bus + ")", describe(info));
}

std::optional<CameraFault> V4l2Camera::open_device() {
  fallback_.adopt_common_level();
  std::optional<CameraFault> fault =
      stream_.open({locator_.node(), frame_size(), config_.fps, config_.v4l2.format, fallback_.level()});
  pair_->set_stream_info(side_, stream_.info());
  if (!fault) locator_.keep_camera();
  return fault;
}

std::optional<CameraFault> V4l2Camera::start_stream() {
  pair_->stream_started(side_, system_.now_ns());
  std::optional<CameraFault> fault = stream_.start(exposure_.exposure_ns());
  if (!fault) stall_.stream_started(system_.now_ns(), stream_.frame_time_ns());
  return fault;
}

void V4l2Camera::setup_failed(CameraFault fault) {
  const std::int64_t now_ns = system_.now_ns();
  if (fault.reason == CameraReason::kSameCamera && locator_.conflict_may_pass(now_ns)) {
    retry_ns_ = now_ns + kConflictRetry;
    return;
  }
  fallback_.setup_failed(fault);
  const bool absent = fault.stage == SetupStage::kFind || fault.reason == CameraReason::kUnplugged;
  fail(absent ? SourceState::kAbsent : SourceState::kOpening, std::move(fault));
}

FrameLease V4l2Camera::stream_once(std::int64_t until_ns) {
  apply_changes();
  if (lifecycle_ != Lifecycle::kStreaming) return {};
  const WaitResult ready = wait_for_frame(until_ns);
  if (stopping_) return {};
  if (ready.readable || ready.broken) {
    if (FrameLease lease = fetch(ready)) {
      frame_received(lease.frame());
      return lease;
    }
  }
  if (lifecycle_ == Lifecycle::kStreaming) check_stalled();
  return {};
}

// Applies what was requested since the last frame: another format, a restart, other controls.
void V4l2Camera::apply_changes() {
  if (auto change = fallback_.level_change()) {
    fail(SourceState::kOpening, std::move(*change));
    retry_ns_ = 0;
    return;
  }
  if (restart_wanted_) restart_in_phase();
  if (lifecycle_ == Lifecycle::kStreaming) sync_exposure();
}

// Restarts the stream at the time that brings it into phase with the other camera.
void V4l2Camera::restart_in_phase() {
  restart_wanted_ = false;
  stream_.stop();
  system_.sleep_until(pair_->best_start(system_.now_ns() + kMinStopTime));
  if (auto fault = start_stream()) stream_failed(std::move(*fault));
}

void V4l2Camera::sync_exposure() {
  if (exposure_.is_outdated()) return configure_exposure();
  if (exposure_.update(stream_.device(), system_.now_ns())) status_.set_note(exposure_.note());
}

void V4l2Camera::configure_exposure() {
  exposure_.configure(stream_.device(), system_.now_ns());
  status_.set_note(exposure_.note());
}

WaitResult V4l2Camera::wait_for_frame(std::int64_t until_ns) {
  const std::int64_t begin_ns = system_.now_ns();
  const std::int64_t wait_ns = std::max<std::int64_t>(0, std::min(until_ns, stall_.deadline_ns()) - begin_ns);
  const WaitResult ready = waiter_->wait(stream_.descriptor(), wait_ms(wait_ns));
  stall_.thread_was_late(system_.now_ns() - begin_ns - wait_ns);
  return ready;
}

FrameLease V4l2Camera::fetch(const WaitResult& ready) {
  int error = 0;
  SetupStage stage = SetupStage::kDequeue;
  const std::int64_t seen_before = stream_.buffers_seen();
  FrameLease lease = stream_.newest(error, stage);
  const bool nothing_dequeued = stream_.buffers_seen() == seen_before;
  if (error == 0 && ready.broken && nothing_dequeued) {
    error = EIO;
    stage = SetupStage::kWait;
  }
  if (error != 0) {
    lease.end();
    stream_failed(fault_of(stage, error, locator_.node()));
    return {};
  }
  // A driver that is readable without a frame must not keep this thread busy.
  if (!lease && nothing_dequeued) waiter_->wait(-1, std::chrono::milliseconds(1));
  return lease;
}

void V4l2Camera::frame_received(const Frame& frame) {
  stall_.frame_received(system_.now_ns());
  if (status_.state() != SourceState::kStreaming) {
    pair_->set_streaming(side_, true);
    fallback_.streaming();
    status_.streaming();
  }
  restart_wanted_ = pair_->frame_received(side_, frame.captured_ns);
}

void V4l2Camera::check_stalled() {
  if (system_.now_ns() < stall_.deadline_ns()) return;
  const std::string& node = locator_.node();
  const std::string timeout = seconds_text(stall_.timeout_ns());
  CameraFault fault{CameraReason::kSilent, SetupStage::kWait, 0,
                    node + ": no frame for " + timeout + "; restarting the stream until frames arrive"};
  if (stream_.buffers_since_frame() > 0) {
    fault.reason = CameraReason::kOnlyDamaged;
    fault.sentence = node + ": only damaged frames for " + timeout + ", the last one " +
                     std::string(name_of(stream_.last_damage())) +
                     "; check its cable, or set cameras.v4l2.format";
  } else {
    fallback_.stream_silent(stall_.has_frame(), fault);
  }
  stall_.stalled();
  fail(SourceState::kStalled, std::move(fault));
  retry_ns_ = 0;
}

void V4l2Camera::close_when_returned(std::int64_t until_ns) {
  if (stream_.on_loan()) {
    const std::int64_t wait_ns = std::min(until_ns - system_.now_ns(), kLoanCheckPeriod);
    waiter_->wait(-1, std::chrono::milliseconds(std::max<std::int64_t>(1, wait_ns / kMs)));
    return;
  }
  stream_.close();
  lifecycle_ = Lifecycle::kClosed;
}

void V4l2Camera::stream_failed(CameraFault fault) {
  fallback_.stream_failed(fault);
  fail(SourceState::kLost, std::move(fault));
}

// Stops the stream and begins to close the device.
void V4l2Camera::fail(SourceState state, CameraFault fault) {
  const bool missing = fault.stage == SetupStage::kFind || fault.reason == CameraReason::kUnplugged;
  stream_.stop();
  pair_->set_streaming(side_, false);
  pair_->stream_stopped(side_);
  if (missing) stall_.forget_starts();
  restart_wanted_ = false;
  lifecycle_ = Lifecycle::kClosing;
  const std::int64_t now_ns = system_.now_ns();
  retry_ns_ = now_ns + (missing ? kSearchPeriod : kRetryDelay);
  status_.failed(state, std::move(fault), now_ns);
}

void V4l2Camera::fail_without_memory(const std::exception& error) noexcept {
  try {
    fail(SourceState::kLost, {CameraReason::kNoMemory, SetupStage::kOpen, 0, error.what()});
  } catch (const std::exception&) {
    status_.failed_silently();
  }
}

void V4l2Camera::stop() noexcept {
  stopping_ = true;
  waiter_->wake();
}

SourceReport V4l2Camera::report() const {
  SourceReport report;
  status_.fill(report);
  const DropCounts drops = stream_.drops();
  report.sequence_gaps = stream_.frames_missed();
  report.decode_errors =
      drops[FrameDrop::kNoJpeg] + drops[FrameDrop::kJpegSize] + drops[FrameDrop::kJpegDamaged];
  report.incomplete = drops[FrameDrop::kDriverError] + drops[FrameDrop::kEmpty] + drops[FrameDrop::kShort];
  report.bad_timestamps = drops[FrameDrop::kStale] + drops[FrameDrop::kTimestampBackwards];
  report.superseded = drops[FrameDrop::kSuperseded] + drops[FrameDrop::kNoRoom];
  return report;
}

}  // namespace stereod::v4l2
