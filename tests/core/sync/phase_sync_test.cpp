// SPDX-License-Identifier: BSD-3-Clause
#include "core/sync/phase_sync.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>

#include "tests/support/random_images.h"

namespace stereod {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kSecond = 1'000 * kMs;
constexpr std::int64_t kPeriod = 33'333'333;

/// Two simulated cameras that deliver timestamps only.
struct StereoSource {
  explicit StereoSource(const PhaseSyncOptions& options) : phase(options) {}

  /// Simulates the given time and restarts cameras on request.
  void run(std::int64_t duration_ns) {
    const std::int64_t end = now + duration_ns;
    while (true) {
      const std::int64_t next = std::min(left_ns, right_ns);
      if (next >= end) break;
      now = next;
      if (left_ns <= right_ns) {
        phase.add(Side::kLeft, left_ns + jitter());
        left_ns += left_period_ns;
        ++left_frames;
      } else {
        phase.add(Side::kRight, right_ns + jitter());
        right_ns += kPeriod + kPeriod * drift_ppb / 1'000'000'000;
        ++right_frames;
      }
      if (const auto side = phase.restart_wanted()) {
        const std::int64_t at = phase.best_start(now + 5 * kMs);
        EXPECT_GE(at, now + 5 * kMs);
        EXPECT_LE(at, now + 5 * kMs + kPeriod);
        phase.started(*side, at);
        (*side == Side::kLeft ? left_ns : right_ns) = first_frame(at);
        ++(*side == Side::kLeft ? left_restarts : right_restarts);
      }
    }
    now = end;
  }

  std::int64_t true_skew() const {
    std::int64_t skew = (right_ns - left_ns) % kPeriod;
    if (skew > kPeriod / 2) skew -= kPeriod;
    if (skew < -kPeriod / 2) skew += kPeriod;
    return skew;
  }
  std::int64_t jitter() { return noise_us > 0 ? random.between(-noise_us, noise_us) * 1000 : 0; }

  PhaseSync phase;
  Random random{3};
  std::int64_t now = 1000 * kSecond;
  std::int64_t left_ns = now + 7 * kMs;
  std::int64_t right_ns = now + 23 * kMs;  // 16 ms later
  std::int64_t left_period_ns = kPeriod;
  std::int64_t drift_ppb = 0;
  int noise_us = 0;
  int left_restarts = 0, right_restarts = 0, left_frames = 0, right_frames = 0;
  std::function<std::int64_t(std::int64_t)> first_frame = [](std::int64_t at) { return at + 217 * kMs; };
};

TEST(PhaseSync, FixedStartTime_AlignsWithSecondRestart) {
  StereoSource rig({});
  rig.noise_us = 300;
  rig.run(10 * kSecond);
  EXPECT_EQ(rig.phase.state(), PhaseSyncState::kAligned);
  EXPECT_LT(std::abs(rig.true_skew()), kMs);
  EXPECT_NEAR(static_cast<double>(*rig.phase.skew_ns()), static_cast<double>(rig.true_skew()), 0.3e6);
  EXPECT_EQ(rig.right_restarts, 2);
  EXPECT_EQ(rig.left_restarts, 0);
  EXPECT_EQ(rig.phase.restarts(), 2);
}

TEST(PhaseSync, EveryPhase_Aligns) {
  for (int ms = 0; ms < 33; ++ms) {
    StereoSource rig({});
    rig.right_ns = rig.left_ns + ms * kMs;
    rig.noise_us = 200;
    rig.run(10 * kSecond);
    EXPECT_EQ(rig.phase.state(), PhaseSyncState::kAligned) << ms;
    EXPECT_LT(std::abs(rig.true_skew()), 3.3 * kMs) << ms;
    EXPECT_LE(rig.right_restarts, 2) << ms;
  }
}

TEST(PhaseSync, RandomStartTime_RetriesUntilAligned) {
  int aligned = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    PhaseSyncOptions options;
    options.tries = 20;
    StereoSource rig(options);
    Random start(seed);
    rig.first_frame = [&](std::int64_t at) { return at + start.between(200'000, 300'000) * 1000; };
    rig.run(60 * kSecond);
    if (rig.phase.state() != PhaseSyncState::kAligned) continue;
    ++aligned;
    EXPECT_LE(std::abs(rig.true_skew()), 3 * kMs);
  }
  EXPECT_GE(aligned, 47) << "each throw hits with 18 %, so 20 of them with 98 %";
}

TEST(PhaseSync, TriesExhausted_GivesUp) {
  PhaseSyncOptions options;
  options.tries = 4;
  StereoSource rig(options);
  int n = 0;
  // Every start lands about half a frame period away.
  rig.first_frame = [&](std::int64_t at) {
    const std::int64_t off = kPeriod / 2 + (n++ % 2 == 0 ? 3 : -3) * kMs;
    const std::int64_t since = (at + 200 * kMs - rig.left_ns) / kPeriod + 1;
    return rig.left_ns + since * kPeriod + off;
  };
  rig.run(60 * kSecond);
  EXPECT_EQ(rig.phase.state(), PhaseSyncState::kGivenUp);
  EXPECT_EQ(rig.right_restarts, 4);
  EXPECT_GT(std::abs(*rig.phase.skew_ns()), 10 * kMs);
  rig.run(1200 * kSecond);
  EXPECT_EQ(rig.right_restarts, 4) << "and stays so";
}

TEST(PhaseSync, RestartWithoutEffect_GivesUpEarly) {
  StereoSource rig({});
  rig.first_frame = [&](std::int64_t at) {
    return rig.right_ns + ((at - rig.right_ns) / kPeriod + 6) * kPeriod;
  };
  rig.run(30 * kSecond);
  EXPECT_EQ(rig.phase.state(), PhaseSyncState::kGivenUp);
  EXPECT_EQ(rig.right_restarts, 3);
}

TEST(PhaseSync, DriftForAnHour_IsTracked) {
  for (const bool realign : {false, true}) {
    PhaseSyncOptions options;
    options.realign = realign;
    StereoSource rig(options);
    rig.drift_ppb = 20'000;  // 20 µs a second: 6 ms in five minutes
    rig.noise_us = 200;
    rig.run(5 * kSecond);
    ASSERT_EQ(rig.phase.state(), PhaseSyncState::kAligned);
    const int restarts = rig.right_restarts;
    std::int64_t worst = 0;
    bool drifted = false;
    for (int second = 0; second < 3600; ++second) {
      rig.run(kSecond);
      if (rig.phase.state() == PhaseSyncState::kAligned) worst = std::max(worst, std::abs(rig.true_skew()));
      drifted = drifted || rig.phase.state() == PhaseSyncState::kDrifted;
    }
    if (realign) {
      EXPECT_LT(worst, 6.5 * kMs) << "twice the target and what noise adds";
      EXPECT_GE(rig.right_restarts - restarts, 8);
      EXPECT_LE(rig.right_restarts - restarts, 16);
      EXPECT_GT(rig.right_frames, 107'000) << "of 108,000";
    } else {
      EXPECT_TRUE(drifted);
      EXPECT_EQ(rig.right_restarts, restarts);
    }
    EXPECT_EQ(rig.left_restarts, 0);
  }
}

TEST(PhaseSync, FastDrift_RealignsEvery30s) {
  PhaseSyncOptions options;
  options.realign = true;
  StereoSource rig(options);
  rig.drift_ppb = 2'000'000;  // 2 ms a second: too fast to align
  rig.run(600 * kSecond);
  EXPECT_LE(rig.right_restarts, 20 * options.tries);
  EXPECT_GT(rig.right_frames, 15'000);
}

TEST(PhaseSync, CameraReturns_IsTheOneRestarted) {
  StereoSource rig({});
  rig.phase.started(Side::kLeft, rig.now);
  rig.phase.started(Side::kRight, rig.now);
  rig.run(10 * kSecond);
  ASSERT_EQ(rig.phase.state(), PhaseSyncState::kAligned);
  const int right_restarts = rig.right_restarts;
  rig.phase.interrupted(Side::kLeft);
  EXPECT_EQ(rig.phase.state(), PhaseSyncState::kWaiting);
  rig.phase.started(Side::kLeft, rig.now + kSecond);
  rig.left_ns = rig.now + kSecond + 217 * kMs;
  rig.run(10 * kSecond);
  EXPECT_EQ(rig.phase.state(), PhaseSyncState::kAligned);
  EXPECT_LE(std::abs(rig.true_skew()), 3 * kMs);
  EXPECT_EQ(rig.right_restarts, right_restarts);
  EXPECT_GE(rig.left_restarts, 1);
}

TEST(PhaseSync, DifferentRates_NoRestart) {
  PhaseSync phase({});
  for (int i = 0; i < 300; ++i) {
    phase.add(Side::kLeft, i * kPeriod);
    if (i % 2 == 0) phase.add(Side::kRight, i * kPeriod + 16 * kMs);
  }
  EXPECT_EQ(phase.state(), PhaseSyncState::kWaiting);
  EXPECT_FALSE(phase.restart_wanted());
  EXPECT_FALSE(phase.skew_ns());
}

TEST(PhaseSync, RateChanges_PhaseIsForgotten) {
  StereoSource rig({});
  rig.run(10 * kSecond);
  ASSERT_EQ(rig.phase.state(), PhaseSyncState::kAligned);
  rig.left_period_ns = 2 * kPeriod;
  rig.run(10 * kSecond);
  EXPECT_EQ(rig.phase.state(), PhaseSyncState::kWaiting);
  EXPECT_FALSE(rig.phase.skew_ns());
  rig.left_period_ns = kPeriod;
  rig.run(10 * kSecond);
  EXPECT_EQ(rig.phase.state(), PhaseSyncState::kAligned);
}

TEST(PhaseSync, Off_OnlyMeasures) {
  PhaseSyncOptions options;
  options.enabled = false;
  StereoSource rig(options);
  rig.run(10 * kSecond);
  EXPECT_EQ(rig.phase.state(), PhaseSyncState::kNone);
  EXPECT_EQ(*rig.phase.skew_ns(), 16 * kMs);
  EXPECT_EQ(rig.right_restarts, 0);
}

TEST(PhaseSync, LostFrames_StaysAligned) {
  StereoSource rig({});
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    rig.run(50 * kMs);
    if (random.between(0, 9) == 0) rig.left_ns += kPeriod;
    if (random.between(0, 9) == 0) rig.right_ns += 2 * kPeriod;
  }
  EXPECT_EQ(rig.phase.state(), PhaseSyncState::kAligned);
  EXPECT_LE(rig.right_restarts, 2);
}

}  // namespace
}  // namespace stereod
