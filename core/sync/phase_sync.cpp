// SPDX-License-Identifier: BSD-3-Clause
#include "core/sync/phase_sync.h"

#include <algorithm>
#include <cstdlib>

namespace stereod {
namespace {

// Returns the remainder in [−period / 2, period / 2).
std::int64_t wrapped(std::int64_t time_ns, std::int64_t period_ns) {
  std::int64_t rest = time_ns % period_ns;
  if (rest < -period_ns / 2) rest += period_ns;
  if (rest >= (period_ns + 1) / 2) rest -= period_ns;
  return rest;
}

template <std::size_t N>
std::int64_t median(std::array<std::int64_t, N> values) {
  std::nth_element(values.begin(), values.begin() + N / 2, values.end());
  return values[N / 2];
}

}  // namespace

void PhaseSync::add(Side side, std::int64_t time_ns) noexcept {
  Camera& camera = of(side);
  if (camera.started_ns) camera.latency_ns = time_ns - *camera.started_ns;
  camera.started_ns.reset();
  if (camera.seen) camera.intervals[camera.count++ % kSamples] = time_ns - camera.last_ns;
  camera.last_ns = time_ns;
  camera.seen = true;
  if (state_ == PhaseSyncState::kRestarting && side == to_restart_) state_ = PhaseSyncState::kMeasuring;
  if (side == to_restart_) measure(time_ns);
}

void PhaseSync::interrupted(Side side) noexcept {
  Camera& camera = of(side);
  camera.seen = false;
  camera.count = 0;
  camera.started_ns.reset();
  forget_samples();
  state_ = PhaseSyncState::kWaiting;
  skew_before_restart_ns_.reset();
  tries_ = 0;
  unmoved_ = 0;
  was_aligned_ = false;
}

std::optional<std::int64_t> PhaseSync::period_of(const Camera& camera) const noexcept {
  if (camera.count < kSamples) return std::nullopt;
  const std::int64_t period = median(camera.intervals);
  return period > 0 ? std::optional(period) : std::nullopt;
}

// Returns the period of both cameras, or nullopt if it differs: cameras of different rates have no phase.
std::optional<std::int64_t> PhaseSync::common_period() const noexcept {
  const auto left = period_of(left_), right = period_of(right_);
  if (!left || !right || std::abs(*left - *right) > *left / 50) return std::nullopt;
  return left;
}

void PhaseSync::measure(std::int64_t time_ns) noexcept {
  const auto period = common_period();
  if (!period && period_of(left_) && period_of(right_)) lose_phase();
  if (!period || state_ == PhaseSyncState::kRestarting) return;
  if (state_ == PhaseSyncState::kWaiting) state_ = PhaseSyncState::kMeasuring;
  const std::int64_t ahead = wrapped(time_ns - of(opposite(to_restart_)).last_ns, *period);
  skews_[skew_count_++] = to_restart_ == Side::kRight ? ahead : -ahead;
  if (skew_count_ < kSamples) return;
  // Near half a period the sign is random, so samples are taken relative to the first one.
  const std::int64_t first = skews_[0];
  for (std::int64_t& skew : skews_) skew = wrapped(skew - first, *period);
  skew_count_ = 0;
  skew_ns_ = wrapped(first + median(skews_), *period);
  evaluate(*skew_ns_, *period, time_ns);
}

// Forgets the phase, after a camera has changed its rate.
void PhaseSync::lose_phase() noexcept {
  forget_samples();
  skew_ns_.reset();
  was_aligned_ = false;
  if (state_ != PhaseSyncState::kRestarting) state_ = PhaseSyncState::kWaiting;
}

void PhaseSync::evaluate(std::int64_t skew_ns, std::int64_t period_ns, std::int64_t now_ns) noexcept {
  if (!options_.enabled) {
    state_ = PhaseSyncState::kNone;
    return;
  }
  const std::int64_t distance = std::abs(skew_ns);
  if (distance <= options_.target_ns || (was_aligned_ && distance <= 2 * options_.target_ns)) {
    state_ = PhaseSyncState::kAligned;
    was_aligned_ = true;
    tries_ = 0;
    unmoved_ = 0;
    skew_before_restart_ns_.reset();
    return;
  }
  const bool given_up = state_ == PhaseSyncState::kGivenUp;
  if (was_aligned_ || given_up) {
    const std::int64_t pause = given_up ? kRetryPause : kRealignPause;
    if (!given_up) state_ = PhaseSyncState::kDrifted;
    if (!options_.realign || now_ns - last_restart_ns_ < pause) return;
    was_aligned_ = false;
    tries_ = 0;
    unmoved_ = 0;
    skew_before_restart_ns_.reset();
  }
  request_restart(skew_ns, period_ns, now_ns);
}

void PhaseSync::request_restart(std::int64_t skew_ns, std::int64_t period_ns, std::int64_t now_ns) noexcept {
  if (skew_before_restart_ns_) {
    const bool moved = std::abs(wrapped(skew_ns - *skew_before_restart_ns_, period_ns)) > period_ns / 50;
    unmoved_ = moved ? 0 : unmoved_ + 1;
  }
  if (tries_ >= options_.tries || unmoved_ >= kMaxUnmoved) {
    state_ = PhaseSyncState::kGivenUp;
    last_restart_ns_ = now_ns;
    return;
  }
  ++tries_;
  ++restarts_;
  skew_before_restart_ns_ = skew_ns;
  last_restart_ns_ = now_ns;
  state_ = PhaseSyncState::kRestarting;
}

std::optional<Side> PhaseSync::restart_wanted() const noexcept {
  const Camera& camera = of(to_restart_);
  if (state_ != PhaseSyncState::kRestarting || camera.started_ns) return std::nullopt;
  return to_restart_;
}

std::int64_t PhaseSync::best_start(std::int64_t ready_ns) const noexcept {
  const auto period = period_of(of(opposite(to_restart_)));
  const Camera& camera = of(to_restart_);
  if (!period || !camera.latency_ns) return ready_ns;
  const std::int64_t late =
      wrapped(of(opposite(to_restart_)).last_ns - ready_ns - *camera.latency_ns, *period);
  return ready_ns + (late < 0 ? late + *period : late);
}

void PhaseSync::started(Side side, std::int64_t at_ns) noexcept {
  Camera& camera = of(side);
  const bool restart = restart_wanted() == side;
  camera.started_ns = at_ns;
  camera.seen = false;
  camera.count = 0;
  forget_samples();
  if (restart) return;
  camera.came_ns = at_ns;
  if (!left_.came_ns || !right_.came_ns) return;
  to_restart_ = *left_.came_ns > *right_.came_ns + kTogether ? Side::kLeft : Side::kRight;
}

void PhaseSync::forget_samples() noexcept { skew_count_ = 0; }

}  // namespace stereod
