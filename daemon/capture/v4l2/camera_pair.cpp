#include "daemon/capture/v4l2/camera_pair.h"

#include <algorithm>

namespace stereod {
namespace {

PhaseOptions phase_options(const V4l2Config& config) {
  PhaseOptions options;
  options.align = config.align != AlignMode::kNever;
  options.realign = config.align == AlignMode::kAlways;
  options.target_ns = static_cast<std::int64_t>(config.target_skew_ms * 1e6);
  options.tries = config.align_tries;
  return options;
}

}  // namespace

std::string_view name_of(PhaseState state) {
  switch (state) {
    case PhaseState::kOff:
      return "off";
    case PhaseState::kWaiting:
      return "waiting";
    case PhaseState::kMeasuring:
      return "measuring";
    case PhaseState::kRestarting:
      return "restarting";
    case PhaseState::kAligned:
      return "aligned";
    case PhaseState::kDrifted:
      return "drifted";
    case PhaseState::kGivenUp:
      return "given up";
  }
  return "?";
}

CameraPair::CameraPair(const CamerasConfig& config) : config_(config), phase_(phase_options(config.v4l2)) {}

void CameraPair::started(Side side, std::int64_t at_ns) noexcept {
  const std::lock_guard lock(mutex_);
  of(side).running = true;
  phase_.started(side, at_ns);
}

void CameraPair::stopped(Side side) noexcept {
  const std::lock_guard lock(mutex_);
  of(side).running = false;
  phase_.interrupted(side);
}

bool CameraPair::frame(Side side, std::int64_t captured_ns) noexcept {
  const std::lock_guard lock(mutex_);
  phase_.add(side, captured_ns);
  return phase_.restart_wanted() == side;
}

std::int64_t CameraPair::best_start(std::int64_t ready_ns) noexcept {
  const std::lock_guard lock(mutex_);
  return phase_.best_start(ready_ns);
}

PhaseReport CameraPair::phase() noexcept {
  const std::lock_guard lock(mutex_);
  return {phase_.state(), static_cast<double>(phase_.skew_ns().value_or(0)) * 1e-6, phase_.restarts()};
}

void CameraPair::set_exposure(const ExposureValues& values) noexcept {
  const std::lock_guard lock(mutex_);
  exposure_ = values;
}

std::optional<ExposureValues> CameraPair::exposure() noexcept {
  const std::lock_guard lock(mutex_);
  return exposure_;
}

void CameraPair::set_controls(const V4l2Config& config) {
  const std::lock_guard lock(mutex_);
  config_.v4l2.exposure = config.exposure;
  config_.v4l2.controls = config.controls;
  config_.v4l2.left_controls = config.left_controls;
  config_.v4l2.right_controls = config.right_controls;
  exposure_.reset();
  ++controls_number_;
}

V4l2Config CameraPair::controls(int& number) {
  const std::lock_guard lock(mutex_);
  number = controls_number_;
  return config_.v4l2;
}

std::string bus_of(const std::string& bus_info) {
  const std::size_t dash = bus_info.rfind('-');
  const bool port_follows = bus_info.starts_with("usb-") && dash != bus_info.npos && dash > 3;
  return port_follows ? bus_info.substr(0, dash) : bus_info;
}

bool CameraPair::take_device(Side side, const std::string& device) {
  const std::lock_guard lock(mutex_);
  of(side).device.clear();
  of(side).flowing = false;
  if (device.empty() && !of(opposite(side)).present()) begin_ladder_anew();
  if (!device.empty() && device == of(opposite(side)).device) return false;
  of(side).device = device;
  return true;
}

void CameraPair::set_facts(Side side, const StreamFacts& facts) {
  const std::lock_guard lock(mutex_);
  Camera& camera = of(side);
  camera.facts = facts;
  const std::string bus = bus_of(facts.device.bus);
  if (bus.empty() || camera.bus == bus) return;
  if (!camera.bus.empty()) begin_ladder_anew();
  camera.bus = bus;
}

void CameraPair::set_flowing(Side side, bool flowing) {
  const std::lock_guard lock(mutex_);
  of(side).flowing = flowing;
  if (cameras_[0].flowing && cameras_[1].flowing && on_same_bus()) carried_step_ = ladder_step_;
}

bool CameraPair::step_down(Side side, int step) {
  const std::lock_guard lock(mutex_);
  if (config_.v4l2.format != "auto") return false;
  if (ladder_step_ > step) return true;  // the other camera asked for it already
  // The other camera may have a further step where this one has none, and leave it more of the bus.
  const int steps = std::max(of(side).facts.ladder_steps, of(opposite(side)).facts.ladder_steps);
  if (ladder_step_ + 1 >= steps) return false;
  ++ladder_step_;
  return true;
}

bool CameraPair::may_starve(Side side) {
  const std::lock_guard lock(mutex_);
  return of(opposite(side)).running && on_same_bus() && carried_step_ != ladder_step_;
}

bool CameraPair::on_same_bus() const { return cameras_[0].bus == cameras_[1].bus; }

void CameraPair::begin_ladder_anew() {
  ladder_step_ = 0;
  carried_step_ = -1;
}

std::string CameraPair::bandwidth_sentence(Side side) {
  const std::lock_guard lock(mutex_);
  const Camera& own = of(side);
  const Camera& other = of(opposite(side));
  std::string sentence = "the bus " + own.bus + " cannot carry " + describe(own.facts);
  if (other.present() && on_same_bus()) {
    sentence += " beside the other camera's " + describe(other.facts);
  }
  const bool compressed = own.facts.pixels != nullptr && own.facts.pixels->work == LumaWork::kJpeg;
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
