// SPDX-License-Identifier: BSD-3-Clause
// The state that two cameras share.
#include "daemon/capture/v4l2/v4l2_pair_state.h"

#include <algorithm>

#include "core/base/enum_names.h"

namespace stereod::v4l2 {
namespace {

PhaseSyncOptions sync_options(const V4l2Config& config) {
  PhaseSyncOptions options;
  options.enabled = config.sync != SyncMode::kNone;
  options.realign = config.sync == SyncMode::kAlways;
  options.target_ns = static_cast<std::int64_t>(config.max_sync_skew_ms * 1e6);
  options.tries = config.sync_attempts;
  return options;
}

constexpr EnumNames<PhaseSyncState, 7> kSyncStates{{{PhaseSyncState::kNone, "none"},
                                                    {PhaseSyncState::kWaiting, "waiting"},
                                                    {PhaseSyncState::kMeasuring, "measuring"},
                                                    {PhaseSyncState::kRestarting, "restarting"},
                                                    {PhaseSyncState::kAligned, "aligned"},
                                                    {PhaseSyncState::kDrifted, "drifted"},
                                                    {PhaseSyncState::kGivenUp, "given up"}}};

}  // namespace

std::string_view name_of(PhaseSyncState state) { return find_name(kSyncStates, state); }

V4l2PairState::V4l2PairState(const CamerasConfig& config)
    : config_(config), phase_sync_(sync_options(config.v4l2)) {}

void V4l2PairState::stream_started(Side side, std::int64_t at_ns) noexcept {
  const std::lock_guard lock(mutex_);
  camera(side).started = true;
  phase_sync_.started(side, at_ns);
}

void V4l2PairState::stream_stopped(Side side) noexcept {
  const std::lock_guard lock(mutex_);
  camera(side).started = false;
  phase_sync_.interrupted(side);
}

bool V4l2PairState::frame_received(Side side, std::int64_t captured_ns) noexcept {
  const std::lock_guard lock(mutex_);
  phase_sync_.add(side, captured_ns);
  return phase_sync_.restart_wanted() == side;
}

std::int64_t V4l2PairState::best_start(std::int64_t ready_ns) noexcept {
  const std::lock_guard lock(mutex_);
  return phase_sync_.best_start(ready_ns);
}

PhaseSyncReport V4l2PairState::sync_report() noexcept {
  const std::lock_guard lock(mutex_);
  return {phase_sync_.state(), static_cast<double>(phase_sync_.skew_ns().value_or(0)) * 1e-6,
          phase_sync_.restarts()};
}

void V4l2PairState::set_exposure(const ExposureValues& values) noexcept {
  const std::lock_guard lock(mutex_);
  exposure_ = values;
}

std::optional<ExposureValues> V4l2PairState::exposure() noexcept {
  const std::lock_guard lock(mutex_);
  return exposure_;
}

void V4l2PairState::set_controls(const V4l2Config& config) {
  const std::lock_guard lock(mutex_);
  config_.v4l2.exposure = config.exposure;
  config_.v4l2.controls = config.controls;
  config_.v4l2.left_controls = config.left_controls;
  config_.v4l2.right_controls = config.right_controls;
  exposure_.reset();
  ++controls_number_;
}

V4l2Config V4l2PairState::controls(int& number) {
  const std::lock_guard lock(mutex_);
  number = controls_number_;
  return config_.v4l2;
}

std::string bus_of(const std::string& bus_info) {
  const std::size_t dash = bus_info.rfind('-');
  const bool port_follows = bus_info.starts_with("usb-") && dash != bus_info.npos && dash > 3;
  return port_follows ? bus_info.substr(0, dash) : bus_info;
}

bool V4l2PairState::claim_device(Side side, const std::string& device) {
  const std::lock_guard lock(mutex_);
  camera(side).device.clear();
  camera(side).streaming = false;
  if (device.empty() && !camera(opposite(side)).present()) reset_fallbacks();
  if (!device.empty() && device == camera(opposite(side)).device) return false;
  camera(side).device = device;
  return true;
}

void V4l2PairState::set_stream_info(Side side, const StreamInfo& info) {
  const std::lock_guard lock(mutex_);
  Camera& own = camera(side);
  own.info = info;
  const std::string bus = bus_of(info.device.bus);
  if (bus.empty() || own.bus == bus) return;
  if (!own.bus.empty()) reset_fallbacks();
  own.bus = bus;
}

void V4l2PairState::set_streaming(Side side, bool streaming) {
  const std::lock_guard lock(mutex_);
  camera(side).streaming = streaming;
  if (cameras_[0].streaming && cameras_[1].streaming && on_same_bus()) proven_level_ = fallback_level_;
}

bool V4l2PairState::fall_back(Side side, int level) {
  const std::lock_guard lock(mutex_);
  if (config_.v4l2.format != "auto") return false;
  if (fallback_level_ > level) return true;  // the other camera has requested it already
  // If only the other camera has a further fallback, it leaves more of the bus to this camera.
  const int levels = std::max(camera(side).info.fallback_levels, camera(opposite(side)).info.fallback_levels);
  if (fallback_level_ + 1 >= levels) return false;
  ++fallback_level_;
  return true;
}

bool V4l2PairState::may_lack_bandwidth(Side side) {
  const std::lock_guard lock(mutex_);
  return camera(opposite(side)).started && on_same_bus() && proven_level_ != fallback_level_;
}

bool V4l2PairState::on_same_bus() const { return cameras_[0].bus == cameras_[1].bus; }

void V4l2PairState::reset_fallbacks() {
  fallback_level_ = 0;
  proven_level_ = -1;
}

std::string V4l2PairState::bandwidth_sentence(Side side) {
  const std::lock_guard lock(mutex_);
  const Camera& own = camera(side);
  const Camera& other = camera(opposite(side));
  std::string sentence = "the bus " + own.bus + " cannot carry " + describe(own.info);
  if (other.present() && on_same_bus()) {
    sentence += " beside the other camera's " + describe(other.info);
  }
  const bool compressed = own.info.pixel_format != nullptr && own.info.pixel_format->work == LumaWork::kJpeg;
  if (config_.v4l2.format == "auto") {
    sentence += "; plug one camera into another USB controller, or lower cameras.fps or the size";
  } else {
    sentence += compressed ? "; lower cameras.fps or the size, or plug one camera into another USB controller"
                           : "; set cameras.v4l2.format to mjpeg or auto, lower cameras.fps, or plug one "
                             "camera into another USB controller";
  }
  return sentence;
}

}  // namespace stereod::v4l2
