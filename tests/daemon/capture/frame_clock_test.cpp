// SPDX-License-Identifier: BSD-3-Clause
// The clock of recorded and rendered cameras.
#include "daemon/capture/frame_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>

namespace stereod {
namespace {

using namespace std::chrono_literals;

constexpr auto kLongEnough = 20s;
constexpr auto kForever = 24h;  // the test stops such a wait from outside

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

TEST(FrameClockPaced, Frames_ExactPeriodNeverEarly) {
  FrameClock clock(400, {0ns});
  const auto first = clock.wait(0, kLongEnough);
  ASSERT_TRUE(first.has_value());
  std::int64_t last = first->number;
  for (int i = 0; i < 20; ++i) {
    const auto tick = clock.wait(0, kLongEnough);
    ASSERT_TRUE(tick.has_value());
    EXPECT_GT(tick->number, last);
    EXPECT_EQ(tick->captured_ns - first->captured_ns, (tick->number - first->number) * 2'500'000);
    EXPECT_LE(tick->captured_ns, now_ns());
    last = tick->number;
  }
}

TEST(FrameClockPaced, LateConsumer_NewestFrameWithGap) {
  FrameClock clock(1000, {0ns});
  ASSERT_TRUE(clock.wait(0, kLongEnough).has_value());
  std::this_thread::sleep_for(50ms);
  const auto late = clock.wait(0, kLongEnough);
  ASSERT_TRUE(late.has_value());
  EXPECT_GE(late->number, 50);
  const auto next = clock.wait(0, kLongEnough);
  ASSERT_TRUE(next.has_value());
  EXPECT_GT(next->number, late->number);  // skipped frames do not follow later
}

TEST(FrameClockPaced, Offsets_ShareOneOrigin) {
  FrameClock clock(500, {0ns, 1500us, -700us});
  std::int64_t origin = 0;
  for (int round = 0; round < 5; ++round) {
    for (int camera = 0; camera < 3; ++camera) {
      const auto tick = clock.wait(camera, kLongEnough);
      ASSERT_TRUE(tick.has_value());
      const std::int64_t offset = camera == 0 ? 0 : camera == 1 ? 1'500'000 : -700'000;
      const std::int64_t implied = tick->captured_ns - offset - tick->number * 2'000'000;
      if (origin == 0) origin = implied;
      EXPECT_EQ(implied, origin) << "camera " << camera;
    }
  }
}

TEST(FrameClockPaced, FramesOnLoan_NoWait) {
  FrameClock clock(1000, {0ns, 0ns});
  for (int i = 0; i < 5; ++i)
    EXPECT_TRUE(clock.wait(0, kLongEnough).has_value());  // no frame given back, camera 1 idle
}

TEST(FrameClockPaced, NotDue_TimesOut) {
  FrameClock clock(0.001, {0ns});
  const auto first = clock.wait(0, kLongEnough);  // at once
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->number, 0);
  EXPECT_FALSE(clock.wait(0, 2ms).has_value());
  EXPECT_FALSE(clock.wait(0, 0ms).has_value());
}

TEST(FrameClockPaced, Stop_EndsWait) {
  FrameClock clock(0.001, {0ns});
  ASSERT_TRUE(clock.wait(0, kForever).has_value());
  std::jthread stopper([&] {
    std::this_thread::sleep_for(5ms);
    clock.stop(0);
  });
  EXPECT_FALSE(clock.wait(0, kForever).has_value());
  EXPECT_FALSE(clock.wait(0, kForever).has_value());  // and every later wait
}

TEST(FrameClockFree, OneOnLoan_NoneSkipped) {
  FrameClock clock(0, {0ns});
  std::int64_t captured = 0;
  for (int n = 0; n < 50; ++n) {
    const auto tick = clock.wait(0, kLongEnough);
    ASSERT_TRUE(tick.has_value());
    EXPECT_EQ(tick->number, n);
    EXPECT_GE(tick->captured_ns, captured);
    captured = tick->captured_ns;
    EXPECT_FALSE(clock.wait(0, 0ms).has_value());
    clock.give_back(0);
  }
}

TEST(FrameClockFree, TwoCameras_SameTimeInStep) {
  FrameClock clock(0, {0ns, 3ms});
  for (int n = 0; n < 50; ++n) {
    const int leader = n % 2, follower = 1 - leader;
    const auto first = clock.wait(leader, kLongEnough);
    ASSERT_TRUE(first.has_value());
    clock.give_back(leader);
    EXPECT_FALSE(clock.wait(leader, 0ms).has_value());  // the follower has not taken frame n yet
    const auto second = clock.wait(follower, kLongEnough);
    ASSERT_TRUE(second.has_value());
    clock.give_back(follower);
    EXPECT_EQ(first->number, n);
    EXPECT_EQ(second->number, n);
    EXPECT_EQ((second->captured_ns - first->captured_ns) * (leader == 0 ? 1 : -1), 3'000'000);
    EXPECT_LE(std::max(first->captured_ns, second->captured_ns), now_ns());
  }
}

TEST(FrameClockFree, Leader_OneFrameAhead) {
  FrameClock clock(0, {0ns, 0ns});
  const auto left0 = clock.wait(0, kLongEnough);
  const auto right0 = clock.wait(1, kLongEnough);
  clock.give_back(0);
  const auto left1 = clock.wait(0, kLongEnough);  // frame 0 of the right camera is still on loan
  ASSERT_TRUE(left0 && right0 && left1);
  EXPECT_EQ(left1->number, 1);
  EXPECT_FALSE(clock.wait(1, 0ms).has_value());
  clock.give_back(1);
  const auto right1 = clock.wait(1, kLongEnough);
  ASSERT_TRUE(right1.has_value());
  EXPECT_EQ(right1->captured_ns, left1->captured_ns);
}

TEST(FrameClockFree, GiveBack_WakesCamera) {
  FrameClock clock(0, {0ns});
  ASSERT_TRUE(clock.wait(0, kLongEnough).has_value());
  std::jthread consumer([&] {
    std::this_thread::sleep_for(5ms);
    clock.give_back(0);
  });
  const auto next = clock.wait(0, kLongEnough);
  ASSERT_TRUE(next.has_value());
  EXPECT_EQ(next->number, 1);
}

TEST(FrameClockFree, StoppedCamera_OtherContinues) {
  FrameClock clock(0, {0ns, 0ns});
  ASSERT_TRUE(clock.wait(0, kLongEnough).has_value());
  clock.give_back(0);
  std::jthread stopper([&] {
    std::this_thread::sleep_for(5ms);
    clock.stop(1);
  });
  for (int n = 1; n < 5; ++n) {
    const auto tick = clock.wait(0, kLongEnough);
    ASSERT_TRUE(tick.has_value());
    EXPECT_EQ(tick->number, n);
    clock.give_back(0);
  }
  EXPECT_FALSE(clock.wait(1, kForever).has_value());
}

TEST(FrameClock, RateOutOfRange_Throws) {
  for (const double fps : {-1.0, 1000.5, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(FrameClock(fps, {0ns}), std::invalid_argument) << fps;
  }
  try {
    const FrameClock clock(-2, {0ns});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "frame rate -2 Hz (allowed 0…1000)");
  }
}

}  // namespace
}  // namespace stereod
