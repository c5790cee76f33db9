#include "daemon/capture/v4l2/v4l2_pair_state.h"

#include <algorithm>

namespace stereod {
namespace {

PhaseSyncOptions phase_options(const V4l2Config& config) {
  PhaseSyncOptions options;
  options.enabled = config.sync != SyncMode::kNone;
  options.realign = config.sync == SyncMode::kAlways;
  options.target_ns = static_cast<std::int64_t>(config.max_sync_skew_ms * 1e6);
  options.tries = config.sync_attempts;
  return options;
}

}  // namespace

std::string_view name_of(PhaseSyncState state) {
  switch (state) {
    case PhaseSyncState::kOff:
      return "off";
    case PhaseSyncState::kWaiting:
      return "waiting";
    case PhaseSyncState::kMeasuring:
      return "measuring";
    case PhaseSyncState::kRestarting:
      return "restarting";
    case PhaseSyncState::kAligned:
      return "aligned";
    case PhaseSyncState::kDrifted:
      return "drifted";
    case PhaseSyncState::kGivenUp:
      return "given up";
  }
  return "?";
}

V4l2PairState::V4l2PairState(const CamerasConfig& config)
    : config_(config), phase_(phase_options(config.v4l2)) {}

void V4l2PairState::started(Side side, std::int64_t at_ns) noexcept {
  const std::lock_guard lock(mutex_);
  of(side).running = true;
  phase_.started(side, at_ns);
}

void V4l2PairState::stopped(Side side) noexcept {
  const std::lock_guard lock(mutex_);
  of(side).running = false;
  phase_.interrupted(side);
}

bool V4l2PairState::frame(Side side, std::int64_t captured_ns) noexcept {
  const std::lock_guard lock(mutex_);
  phase_.add(side, captured_ns);
  return phase_.restart_wanted() == side;
}

std::int64_t V4l2PairState::best_start(std::int64_t ready_ns) noexcept {
  const std::lock_guard lock(mutex_);
  return phase_.best_start(ready_ns);
}

PhaseSyncReport V4l2PairState::phase() noexcept {
  const std::lock_guard lock(mutex_);
  return {phase_.state(), static_cast<double>(phase_.skew_ns().value_or(0)) * 1e-6, phase_.restarts()};
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

bool V4l2PairState::take_device(Side side, const std::string& device) {
  const std::lock_guard lock(mutex_);
  of(side).device.clear();
  of(side).flowing = false;
  if (device.empty() && !of(opposite(side)).present()) reset_fallbacks();
  if (!device.empty() && device == of(opposite(side)).device) return false;
  of(side).device = device;
  return true;
}

void V4l2PairState::set_stream_info(Side side, const StreamInfo& info) {
  const std::lock_guard lock(mutex_);
  Camera& camera = of(side);
  camera.info = info;
  const std::string bus = bus_of(info.device.bus);
  if (bus.empty() || camera.bus == bus) return;
  if (!camera.bus.empty()) reset_fallbacks();
  camera.bus = bus;
}

void V4l2PairState::set_flowing(Side side, bool flowing) {
  const std::lock_guard lock(mutex_);
  of(side).flowing = flowing;
  if (cameras_[0].flowing && cameras_[1].flowing && on_same_bus()) carried_step_ = fallback_level_;
}

bool V4l2PairState::step_down(Side side, int step) {
  const std::lock_guard lock(mutex_);
  if (config_.v4l2.format != "auto") return false;
  if (fallback_level_ > step) return true;  // the other camera asked for it already
  // The other camera may have a further step where this one has none, and leave it more of the bus.
  const int steps = std::max(of(side).info.fallback_levels, of(opposite(side)).info.fallback_levels);
  if (fallback_level_ + 1 >= steps) return false;
  ++fallback_level_;
  return true;
}

bool V4l2PairState::may_starve(Side side) {
  const std::lock_guard lock(mutex_);
  return of(opposite(side)).running && on_same_bus() && carried_step_ != fallback_level_;
}

bool V4l2PairState::on_same_bus() const { return cameras_[0].bus == cameras_[1].bus; }

void V4l2PairState::reset_fallbacks() {
  fallback_level_ = 0;
  carried_step_ = -1;
}

std::string V4l2PairState::bandwidth_sentence(Side side) {
  const std::lock_guard lock(mutex_);
  const Camera& own = of(side);
  const Camera& other = of(opposite(side));
  std::string sentence = "the bus " + own.bus + " cannot carry " + describe(own.info);
  if (other.present() && on_same_bus()) {
    sentence += " beside the other camera's " + describe(other.info);
  }
  const bool compressed = own.info.pixels != nullptr && own.info.pixels->work == LumaWork::kJpeg;
  if (config_.v4l2.format == "auto") {
    sentence += "; plug one camera into another USB controller, or lower cameras.fps or the size";
  } else {
    sentence += compressed ? "; lower cameras.fps or the size, or plug one camera into another USB controller"
                           : "; set cameras.v4l2.format to mjpeg or auto, lower cameras.fps, or plug one "
                             "camera into another USB controller";
  }
  return sentence;
}

}  // namespace stereod
