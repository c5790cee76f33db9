// SPDX-License-Identifier: BSD-3-Clause
// Makes two free-running cameras expose at the same time.
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
  int tries = 8;  ///< restarts in a row until kGivenUp
};

enum class PhaseSyncState {
  kNone,     ///< disabled; the skew is measured nevertheless
  kWaiting,  ///< for frames of both cameras
  kMeasuring,
  kRestarting,  ///< a camera must be restarted, or was restarted and has delivered no frame yet
  kAligned,
  kDrifted,  ///< no longer aligned, and restarts are not allowed (yet)
  kGivenUp,  ///< alignment failed
};

/// Decides, from frame timestamps alone, when to restart a camera so that both expose at the same time. Knows
/// no clock and no device.
///
/// Two webcams of the same rate start with a random phase, and neither can be told when to expose, but a
/// restart changes the phase. PhaseSync measures the skew as a median over frames. If it exceeds the target,
/// it asks for a restart of the camera that came last (at first the right one), so that a camera that was not
/// disturbed is never restarted.
///
///   * A camera whose first frame comes a fixed time after its start is aligned by the second restart: the
///     first one measures that time, the second one is placed so that the first frame coincides with one of
///     the other camera.
///   * For a camera whose start takes a random time each restart is a new try, at most `tries` in a row.
///   * A camera whose exposure keeps its phase while the stream is stopped comes back with the same skew.
///     After three such restarts the state is kGivenUp at once.
///
/// Aligned cameras drift apart, because their crystals differ. When the skew exceeds twice the target and
/// `realign` allows it, they are aligned again, at most once in 30 s; after kGivenUp at most once in 10 min.
class PhaseSync {
 public:
  explicit PhaseSync(const PhaseSyncOptions& options) : options_(options) {}

  /// Adds a frame of one camera, captured at @p time_ns. Times of one camera ascend.
  void add(Side side, std::int64_t time_ns) noexcept;

  /// Says that a camera has stopped: forgets all measurements.
  void interrupted(Side side) noexcept;

  /// Returns the camera to restart now, if any.
  std::optional<Side> restart_wanted() const noexcept;
  /// Returns when to start that camera, at most one frame period after @p ready_ns, the earliest time
  /// possible.
  std::int64_t best_start(std::int64_t ready_ns) const noexcept;
  /// Says that the stream of a camera was started at @p at_ns, on request or not.
  void started(Side side, std::int64_t at_ns) noexcept;

  PhaseSyncState state() const noexcept { return state_; }
  /// Returns the latest skew, right − left timestamp, within half a frame period; nullopt before the first
  /// measurement.
  std::optional<std::int64_t> skew_ns() const noexcept { return skew_ns_; }
  std::int64_t restarts() const noexcept { return restarts_; }

 private:
  static constexpr std::size_t kSamples = 15;
  static constexpr std::int64_t kRealignPause = 30'000'000'000;
  static constexpr std::int64_t kRetryPause = 600'000'000'000;  // after giving up
  static constexpr int kMaxUnmoved = 3;                     // restarts in a row that leave the skew as it was
  static constexpr std::int64_t kTogether = 5'000'000'000;  // starts within this time count as simultaneous

  struct Camera {
    std::int64_t last_ns = 0;
    bool seen = false;
    std::array<std::int64_t, kSamples> intervals{};
    std::size_t count = 0;
    std::optional<std::int64_t> started_ns;  // reset by the first frame
    std::optional<std::int64_t> latency_ns;  // from the start to the first frame
    std::optional<std::int64_t> came_ns;     // started, but not by a restart
  };
  Camera& of(Side side) noexcept { return side == Side::kLeft ? left_ : right_; }
  const Camera& of(Side side) const noexcept { return side == Side::kLeft ? left_ : right_; }

  std::optional<std::int64_t> period_of(const Camera& camera) const noexcept;
  std::optional<std::int64_t> common_period() const noexcept;
  void measure(std::int64_t time_ns) noexcept;
  void evaluate(std::int64_t skew_ns, std::int64_t period_ns, std::int64_t now_ns) noexcept;
  void request_restart(std::int64_t skew_ns, std::int64_t period_ns, std::int64_t now_ns) noexcept;
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
