#include "daemon/capture/v4l2/v4l2_camera.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <utility>

#include "daemon/capture/v4l2/camera_finder.h"

namespace stereod {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kRetry = kSecond / 2;  // after a failure
constexpr std::int64_t kLookAgain = kSecond;  // for an absent camera, should an event be missed
// Until a frame comes after a start: webcams may take two seconds when they have just been plugged in, and
// most are faster after that. Once a camera has shown how long it takes it is not waited for much longer, so
// that one that needs a new start to come to itself gets it soon; and so that one that has never delivered
// does, only its first, second, fourth, eighth … start is given that long.
constexpr std::int64_t kColdStart = 3 * kSecond;
constexpr std::int64_t kSilence = kSecond;
constexpr int kRefusals = 3;  // of a format, before the next is tried
constexpr std::int64_t kLoanCheck = kSecond / 100;
constexpr std::int64_t kStopTime = kSecond / 500;  // a stopped stream can be started after that

std::string side_name(Side side) { return side == Side::kLeft ? "left" : "right"; }

}  // namespace

V4l2Camera::V4l2Camera(VideoSystem& system, std::shared_ptr<V4l2PairState> pair, Side side,
                       const CamerasConfig& config, CameraLog log)
    : system_(system),
      pair_(std::move(pair)),
      side_(side),
      config_(config),
      size_{config.v4l2.width, config.v4l2.height},
      log_(std::move(log)),
      waiter_(system.make_waiter()),
      stream_(system, size_),
      exposure_(*pair_, side, config.v4l2),
      name_(side == Side::kLeft ? config.v4l2.left : config.v4l2.right) {
  fault_ = {CameraReason::kNotFound, SetupStage::kFind, 0, "not looked for yet"};
}

FrameLease V4l2Camera::next(std::chrono::milliseconds timeout) noexcept {
  const std::int64_t until_ns = system_.now_ns() + std::int64_t{timeout.count()} * 1'000'000;
  do {
    if (stopping_) return {};
    try {
      if (FrameLease lease = step(until_ns)) return lease;
    } catch (const std::exception& error) {  // no memory for a list of formats, say
      out_of_memory(error);
    }
  } while (system_.now_ns() < until_ns);
  return {};
}

// Where there is no memory a sentence may fail too; the next round tries again after a pause.
void V4l2Camera::out_of_memory(const std::exception& error) noexcept {
  try {
    fail(CameraState::kLost, {CameraReason::kNoMemory, SetupStage::kOpen, 0, error.what()});
  } catch (const std::exception&) {
    state_ = CameraState::kLost;
  }
}

FrameLease V4l2Camera::step(std::int64_t until_ns) {
  switch (phase_) {
    case Phase::kClosed:
      if (system_.now_ns() < retry_ns_) {
        wait_for_device(until_ns);
      } else {
        open();
      }
      return {};
    case Phase::kClosing:
      finish_closing(until_ns);
      return {};
    case Phase::kFlowing:
      return fetch(until_ns);
  }
  return {};
}

void V4l2Camera::wait_for_device(std::int64_t until_ns) {
  const std::int64_t wait_ns = std::min(until_ns, retry_ns_) - system_.now_ns();
  const auto wait = std::chrono::milliseconds(std::max<std::int64_t>(0, wait_ns) / 1'000'000 + 1);
  if (waiter_->wait(-1, wait).devices_changed) retry_ns_ = 0;
}

void V4l2Camera::open() {
  std::optional<CameraFault> fault = find_and_open();
  if (!fault) {
    exposure_.begin(stream_.device(), system_.now_ns());
    set_note(exposure_.note());
    pair_->started(side_, system_.now_ns());
    fault = stream_.start(exposure_.exposure_ns());
  }
  if (!fault) {
    opened();
    return;
  }
  if (fault->reason == CameraReason::kSameCamera && wait_for_other()) return;
  if (fault->reason == CameraReason::kNoBandwidth) no_bandwidth(*fault);
  count_refusal(*fault);
  const bool absent = fault->step == SetupStage::kFind || fault->reason == CameraReason::kUnplugged;
  fail(absent ? CameraState::kAbsent : CameraState::kOpening, std::move(*fault));
}

// A driver may offer a format that it then does not take; the next on the ladder is as good as another bus.
void V4l2Camera::count_refusal(const CameraFault& fault) {
  const bool refused = fault.step == SetupStage::kSetFormat && (fault.reason == CameraReason::kOtherFormat ||
                                                                fault.reason == CameraReason::kNoFormat);
  refusals_ = refused ? refusals_ + 1 : 0;
  if (refusals_ < kRefusals) return;
  refusals_ = 0;
  pair_->step_down(side_, fallback_level_);
}

// After ports were swapped the other camera may not have noticed yet that it lost what is found here.
bool V4l2Camera::wait_for_other() {
  const std::int64_t now_ns = system_.now_ns();
  if (refused_ns_ == 0) refused_ns_ = now_ns;
  if (now_ns - refused_ns_ >= kRetry) return false;
  retry_ns_ = now_ns + kRetry / 10;
  return true;
}

std::optional<CameraFault> V4l2Camera::find_and_open() {
  std::string stable_name;
  if (auto fault = find_camera(system_, side_, name_, node_, stable_name)) {
    pair_->take_device(side_, "");
    const std::lock_guard lock(mutex_);
    // Who once had it knows more than that there is none.
    if (ever_streamed_ && fault->reason == CameraReason::kNotFound) {
      fault->reason = CameraReason::kUnplugged;
      fault->sentence = "was unplugged: " + fault->sentence;
    }
    return fault;
  }
  if (!pair_->take_device(side_, system_.camera_of(node_))) {
    return CameraFault{CameraReason::kSameCamera, SetupStage::kFind, 0,
                       node_ + " belongs to the camera that is the " + side_name(opposite(side_)) +
                           " one; name two cameras in cameras.v4l2"};
  }
  refused_ns_ = 0;
  fallback_level_ = pair_->fallback_level();
  StreamOptions options{node_, size_, config_.fps, config_.v4l2.format, fallback_level_};
  std::optional<CameraFault> fault = stream_.open(options);
  pair_->set_stream_info(side_, stream_.info());
  if (!fault) name_ = stable_name;
  return fault;
}

void V4l2Camera::opened() {
  phase_ = Phase::kFlowing;
  started();
  const StreamInfo& info = stream_.info();
  frame_time_ns_ = info.fps > 0 ? static_cast<std::int64_t>(1e9 / info.fps) : 0;
  const std::lock_guard lock(mutex_);
  device_ = node_ + " (" + info.device.card + ", " + info.device.bus + ")";
  format_ = describe(info);
  // A wedged or lost camera is that until a frame comes.
  if (state_ == CameraState::kAbsent) state_ = CameraState::kOpening;
}

void V4l2Camera::started() {
  last_good_ns_ = system_.now_ns();
  buffers_at_last_good_ = 0;
  had_frame_ = false;
}

FrameLease V4l2Camera::fetch(std::int64_t until_ns) {
  if (fallback_level_ != pair_->fallback_level()) {
    change_format();
    return {};
  }
  if (restart_wanted_) restart_in_phase();
  if (phase_ != Phase::kFlowing) return {};
  sync_exposure();
  const std::int64_t wait_ns = std::min(until_ns, last_good_ns_ + patience_ns()) - system_.now_ns();
  const auto wait = std::chrono::milliseconds(std::max<std::int64_t>(0, wait_ns) / 1'000'000 + 1);
  const std::int64_t asked_ns = system_.now_ns();
  const WaitResult ready = waiter_->wait(stream_.descriptor(), wait);
  if (stopping_) return {};
  // If it was this process that stood still, the camera is not to blame.
  const std::int64_t late_ns = system_.now_ns() - asked_ns - std::max<std::int64_t>(0, wait_ns);
  if (late_ns > kSilence / 4) last_good_ns_ += late_ns;
  FrameLease lease;
  if (ready.readable || ready.broken) {
    int error = 0;
    SetupStage at = SetupStage::kDequeue;
    const std::int64_t seen_before = stream_.buffers_seen();
    lease = stream_.newest(error, at);
    if (error == 0 && ready.broken && stream_.buffers_seen() == seen_before) {
      error = EIO;
      at = SetupStage::kWait;
    }
    const bool nothing = !lease && error == 0 && stream_.buffers_seen() == seen_before;
    if (nothing) waiter_->wait(-1, std::chrono::milliseconds(1));  // a driver that calls for nothing
    if (error != 0) {
      lease.end();
      lose(fault_of(at, error, node_));
      return {};
    }
  }
  if (lease) {
    const std::int64_t now_ns = system_.now_ns();
    if (!had_frame_) longest_start_ns_ = std::max(longest_start_ns_, now_ns - last_good_ns_);
    starts_in_vain_ = 0;
    last_good_ns_ = now_ns;
    buffers_at_last_good_ = stream_.buffers_seen();
    if (state_ != CameraState::kStreaming) streaming();
    had_frame_ = true;
    restart_wanted_ = pair_->frame(side_, lease.frame().captured_ns);
    return lease;
  }
  check_silence(system_.now_ns());
  return {};
}

// The other camera has changed what both may put on the bus.
void V4l2Camera::change_format() {
  const bool less = pair_->fallback_level() > fallback_level_;
  fail(CameraState::kOpening,
       {less ? CameraReason::kNoBandwidth : CameraReason::kMoreBandwidth, SetupStage::kSetFormat, 0,
        less ? "is set up again with less on the bus, because the other camera cannot get the bandwidth it "
               "needs"
             : "is set up again with its best format, because a camera has moved to another bus"});
  retry_ns_ = 0;
}

// Starts the stream again at the moment that brings it into phase with the other camera.
void V4l2Camera::restart_in_phase() {
  restart_wanted_ = false;
  stream_.stop();
  const std::int64_t start_ns = pair_->best_start(system_.now_ns() + kStopTime);
  system_.sleep_until(start_ns);
  pair_->started(side_, system_.now_ns());
  if (auto fault = stream_.start(exposure_.exposure_ns())) {
    lose(std::move(*fault));
    return;
  }
  started();
}

// Between two frames, when nothing waits.
void V4l2Camera::sync_exposure() {
  if (exposure_.outdated()) {
    exposure_.begin(stream_.device(), system_.now_ns());
    set_note(exposure_.note());
    return;
  }
  if (exposure_.tick(stream_.device(), system_.now_ns())) set_note(exposure_.note());
}

void V4l2Camera::set_note(const std::string& note) {
  const std::lock_guard lock(mutex_);
  if (note == note_) return;
  const bool said = note_.find(note) != note_.npos;  // a part of it may have been withdrawn
  note_ = note;
  if (!said) log_(LogLevel::kWarning, "the " + side_name(side_) + " camera: " + note);
}

// The first frame, or the first again.
void V4l2Camera::streaming() {
  pair_->set_flowing(side_, true);
  silent_starts_ = 0;
  const std::lock_guard lock(mutex_);
  if (ever_streamed_) ++reconnects_;
  if (logged_ != CameraReason::kNone || !ever_streamed_) {
    log_(LogLevel::kInfo, "the " + side_name(side_) + " camera streams" +
                              (ever_streamed_ ? " again: " : ": ") + device_ + ", " + format_);
  }
  ever_streamed_ = true;
  logged_ = CameraReason::kNone;
  fault_ = {};
  state_ = CameraState::kStreaming;
}

std::int64_t V4l2Camera::patience_ns() const noexcept {
  std::int64_t start_ns = 0;
  if (!had_frame_) {
    const bool cold = longest_start_ns_ == 0 && std::has_single_bit(starts_in_vain_ + 1);
    start_ns = cold ? kColdStart : longest_start_ns_ + longest_start_ns_ / 2;
  }
  return std::max({kSilence, std::min(start_ns, kColdStart), 4 * frame_time_ns_.load()});
}

void V4l2Camera::check_silence(std::int64_t now_ns) {
  if (now_ns - last_good_ns_ < patience_ns()) return;
  if (!had_frame_) ++starts_in_vain_;
  const std::int64_t damaged = stream_.buffers_seen() - buffers_at_last_good_;
  CameraFault fault{CameraReason::kSilent, SetupStage::kWait, 0,
                    node_ + " has fallen silent; it is set up again until frames come"};
  if (damaged > 0) {
    fault.reason = CameraReason::kOnlyDamaged;
    fault.sentence = node_ + " sends only damaged frames, the last one " +
                     std::string(name_of(stream_.last_damage())) +
                     "; check its cable, or set cameras.v4l2.format";
  } else {
    // A bus that is full may also show itself by frames that never come.
    const bool starved = !had_frame_ && pair_->may_starve(side_);
    silent_starts_ = starved ? silent_starts_ + 1 : 0;
    if (silent_starts_ >= 2) no_bandwidth(fault);
  }
  fail(CameraState::kStalled, std::move(fault));
  retry_ns_ = 0;  // it was silent long enough
}

// Goes one step down where the configuration allows it, and says what it does.
void V4l2Camera::no_bandwidth(CameraFault& fault) {
  fault.reason = CameraReason::kNoBandwidth;
  fault.sentence = pair_->bandwidth_sentence(side_);
  const bool stepped = pair_->step_down(side_, fallback_level_);
  if (!stepped) return;  // and every start in vain is blamed on the bus
  fault.sentence += "; until then both cameras are set up with less";
  silent_starts_ = 0;
}

// A stream that failed.
void V4l2Camera::lose(CameraFault fault) {
  if (fault.reason == CameraReason::kNoBandwidth) no_bandwidth(fault);
  fail(CameraState::kLost, std::move(fault));
}

void V4l2Camera::fail(CameraState state, CameraFault fault) {
  const bool look_again = fault.step == SetupStage::kFind || fault.reason == CameraReason::kUnplugged;
  stream_.stop();
  pair_->set_flowing(side_, false);
  pair_->stopped(side_);
  if (look_again) {  // the next may be another camera, or a cold one
    longest_start_ns_ = 0;
    starts_in_vain_ = 0;
  }
  restart_wanted_ = false;
  phase_ = Phase::kClosing;
  retry_ns_ = system_.now_ns() + (look_again ? kLookAgain : kRetry);
  const std::lock_guard lock(mutex_);
  // A camera that is set up in vain stays what it became when it failed.
  const bool still_down = state_ == CameraState::kStalled || state_ == CameraState::kLost;
  if (!(still_down && state == CameraState::kOpening)) state_ = state;
  if (fault.reason != fault_.reason || last_fault_ns_ == 0) {
    last_fault_ = fault.sentence;
    last_fault_ns_ = system_.now_ns();
  }
  fault_ = std::move(fault);
  if (fault_.reason == logged_) return;
  logged_ = fault_.reason;
  log_(LogLevel::kWarning,
       "the " + side_name(side_) + " camera is " + std::string(name_of(state_)) + ": " + fault_.sentence);
}

void V4l2Camera::finish_closing(std::int64_t until_ns) {
  if (stream_.on_loan()) {
    const std::int64_t wait_ns = std::min(until_ns - system_.now_ns(), kLoanCheck);
    waiter_->wait(-1, std::chrono::milliseconds(std::max<std::int64_t>(1, wait_ns / 1'000'000)));
    return;
  }
  stream_.close();
  phase_ = Phase::kClosed;
}

SourceState V4l2Camera::state() const noexcept {
  return state_ == CameraState::kStreaming ? SourceState::kStreaming : SourceState::kWaiting;
}

void V4l2Camera::stop() noexcept {
  stopping_ = true;
  waiter_->wake();
}

CameraFault V4l2Camera::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

SourceReport V4l2Camera::report() const {
  const DropCounts drops = stream_.drops();
  const std::lock_guard lock(mutex_);
  SourceReport report;
  report.state = name_of(state_);
  report.reason = state_ == CameraState::kStreaming ? "" : fault_.sentence;
  report.device = device_;
  report.format = format_;
  report.note = note_;
  report.last_fault = last_fault_;
  report.last_fault_ns = last_fault_ns_;
  report.reconnects = reconnects_;
  report.sequence_gaps = stream_.frames_missed();
  report.decode_errors =
      drops[FrameDrop::kNoJpeg] + drops[FrameDrop::kJpegSize] + drops[FrameDrop::kJpegDamaged];
  report.incomplete = drops[FrameDrop::kDriverError] + drops[FrameDrop::kEmpty] + drops[FrameDrop::kShort];
  report.bad_timestamps = drops[FrameDrop::kStale] + drops[FrameDrop::kTimestampBackwards];
  report.superseded = drops[FrameDrop::kSuperseded] + drops[FrameDrop::kNoRoom];
  return report;
}

}  // namespace stereod
