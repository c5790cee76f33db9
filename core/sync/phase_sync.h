// Bringing two free-running cameras to expose at the same time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/sync/pairing.h"

namespace stereod {

struct PhaseSyncOptions {
  bool enabled = true;
  bool realign = false;  ///< also after they have drifted apart
  std::int64_t target_ns = 3'000'000;
  int tries = 8;  ///< restarts in a row before it gives up
};

enum class PhaseSyncState {
  kOff,      ///< not wanted; the skew is measured all the same
  kWaiting,  ///< for frames of both cameras
  kMeasuring,
  kRestarting,  ///< a camera is to be restarted, or was and has given no frame yet
  kAligned,
  kDrifted,  ///< was aligned, is not any more, and may not be restarted (yet)
  kGivenUp,  ///< could not be aligned
};

/// Two webcams of the same rate start with a random phase, and neither can be told when to expose. What can
/// be done is to start one of them again. This decides when, by the time stamps alone: it knows no clock and
/// no device. It measures the skew as a median of frames; if that is above the target it asks for a restart
/// of one camera, the one that came last (the right one at first, so that a camera that was not disturbed
/// never is).
///
/// A camera whose first frame comes a fixed time after its start is aligned with the second restart: that
/// time is learnt, and the restart is put where the first frame falls on the other camera's. For one that
/// takes a random time, each restart is another throw. One whose exposure runs on while its stream is stopped
/// comes back with the same skew each time; after three of those it gives up at once.
///
/// Once aligned, the cameras' crystals let them drift apart. The skew is watched, and when it exceeds twice
/// the target they are aligned again, if `realign` allows it, but not more than once in half a minute.
class PhaseSync {
 public:
  explicit PhaseSync(const PhaseSyncOptions& options) : options_(options) {}

  /// A frame of one camera; times of one camera ascend.
  void add(Side side, std::int64_t time_ns) noexcept;

  /// A camera has stopped; what was measured counts no more.
  void interrupted(Side side) noexcept;

  /// The camera that has to be restarted now, if any.
  std::optional<Side> restart_wanted() const noexcept;
  /// When that camera should be started, if it can be from `ready_ns` on: within one frame time after it.
  std::int64_t best_start(std::int64_t ready_ns) const noexcept;
  /// A camera's stream was started at this time, wanted or not.
  void started(Side side, std::int64_t at_ns) noexcept;

  PhaseSyncState state() const noexcept { return state_; }
  /// Right minus left of the latest measurement, within half a frame; nothing before the first one.
  std::optional<std::int64_t> skew_ns() const noexcept { return skew_ns_; }
  std::int64_t restarts() const noexcept { return restarts_; }

 private:
  static constexpr std::size_t kSamples = 15;
  static constexpr std::int64_t kRealignPause = 30'000'000'000;
  static constexpr std::int64_t kRetryPause = 600'000'000'000;  // after giving up
  static constexpr int kUnmoved = 3;
  static constexpr std::int64_t kTogether = 5'000'000'000;

  struct Camera {
    std::int64_t last_ns = 0;
    bool seen = false;
    std::array<std::int64_t, kSamples> intervals{};
    std::size_t count = 0;
    std::optional<std::int64_t> started_ns;  // until its first frame
    std::optional<std::int64_t> latency_ns;  // from the start to the first frame
    std::optional<std::int64_t> came_ns;     // started, but not by a restart
  };
  Camera& of(Side side) noexcept { return side == Side::kLeft ? left_ : right_; }
  const Camera& of(Side side) const noexcept { return side == Side::kLeft ? left_ : right_; }

  std::optional<std::int64_t> period_of(const Camera& camera) const noexcept;
  std::optional<std::int64_t> common_period() const noexcept;
  void measure(std::int64_t time_ns) noexcept;
  void judge(std::int64_t skew_ns, std::int64_t period_ns, std::int64_t now_ns) noexcept;
  void want_restart(std::int64_t skew_ns, std::int64_t period_ns, std::int64_t now_ns) noexcept;
  void forget_samples() noexcept;
  void lose_phase() noexcept;

  PhaseSyncOptions options_;
  Camera left_, right_;
  Side to_restart_ = Side::kRight;
  PhaseSyncState state_ = PhaseSyncState::kWaiting;
  std::array<std::int64_t, kSamples> skews_{};
  std::size_t skew_count_ = 0;
  std::optional<std::int64_t> skew_ns_;
  std::optional<std::int64_t> skew_before_restart_ns_;
  int tries_ = 0;
  int unmoved_ = 0;
  bool was_aligned_ = false;
  std::int64_t restarts_ = 0;
  std::int64_t last_restart_ns_ = 0;
};

}  // namespace stereod
