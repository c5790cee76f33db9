// What the two cameras of a rig have to know of each other.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/sync/pairing.h"
#include "core/sync/phase_sync.h"
#include "daemon/capture/v4l2/camera_stream.h"
#include "daemon/config/config.h"

namespace stereod {

/// What a camera's exposure is made of; what the camera does not have is missing.
struct ExposureValues {
  std::optional<std::int32_t> time;  ///< exposure_time_absolute, 100 µs
  std::optional<std::int32_t> gain;
  friend bool operator==(const ExposureValues&, const ExposureValues&) = default;
};

/// How far the phase alignment is, for the status message.
struct PhaseSyncReport {
  PhaseSyncState state = PhaseSyncState::kWaiting;
  double skew_ms = 0;
  std::int64_t restarts = 0;
};
std::string_view name_of(PhaseSyncState state);

/// Shared by the two cameras' threads.
class V4l2PairState {
 public:
  explicit V4l2PairState(const CamerasConfig& config);

  /// `device` (VideoSystem::camera_of) is the other camera's already: then it is not taken, and this is
  /// false. Empty: this camera is gone.
  bool take_device(Side side, const std::string& device);

  /// What a camera was set up as, and whether frames come.
  void set_stream_info(Side side, const StreamInfo& info);
  void set_flowing(Side side, bool flowing);

  /// The phase alignment (see there): a stream was started or has stopped, a frame came. True: the camera of
  /// this frame has to be restarted, at `best_start` if it can be from `ready_ns` on.
  void started(Side side, std::int64_t at_ns) noexcept;
  void stopped(Side side) noexcept;
  bool frame(Side side, std::int64_t captured_ns) noexcept;
  std::int64_t best_start(std::int64_t ready_ns) noexcept;
  PhaseSyncReport phase() noexcept;

  /// The exposure that both cameras should have; nothing while none is known.
  void set_exposure(const ExposureValues& values) noexcept;
  std::optional<ExposureValues> exposure() noexcept;

  /// Other controls and another exposure mode for both cameras, which take them between two frames or when
  /// they are set up next. The exposure is found anew.
  void set_controls(const V4l2Config& config);
  /// Their configuration as it is now; each change has a higher number.
  V4l2Config controls(int& number);
  int controls_number() const noexcept { return controls_number_; }

  /// Where on the ladder of formats both cameras stand: both on one step, because two cameras on one bus
  /// share its bandwidth and because matching needs two equal images. It begins anew at the top when both
  /// cameras are gone, and when one comes back on another bus; while one streams it is not disturbed to try.
  int fallback_level() const noexcept { return fallback_level_; }
  /// `side` cannot get the bandwidth it needs at `step`. True: both have now to be set up further down.
  /// False: there is no further step.
  bool step_down(Side side, int step);

  /// Whether the other camera was started on the bus that `side` is on, and nothing has shown yet that the
  /// bus can carry both as they are.
  bool may_starve(Side side);

  /// Says which bus is full, what both cameras ask of it, and what to do.
  std::string bandwidth_sentence(Side side);

 private:
  struct Camera {
    bool present() const { return !device.empty(); }

    std::string device;  // found when it was last looked for; the other camera may not have it
    StreamInfo info;
    std::string bus;       // where it is, or was when it was last there
    bool running = false;  // started
    bool flowing = false;  // and frames come
  };
  bool on_same_bus() const;
  void reset_fallbacks();
  Camera& of(Side side) { return cameras_[side == Side::kLeft ? 0 : 1]; }

  CamerasConfig config_;
  std::atomic<int> controls_number_{0};
  std::mutex mutex_;
  Camera cameras_[2];
  std::atomic<int> fallback_level_{0};
  int carried_step_ = -1;  // of the ladder, at which one bus has carried both
  PhaseSync phase_;
  std::optional<ExposureValues> exposure_;
};

/// The bus of a device by its bus_info: "usb-0000:00:14.0-3.1" is on "usb-0000:00:14.0".
std::string bus_of(const std::string& bus_info);

}  // namespace stereod
