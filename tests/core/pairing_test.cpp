#include "core/pairing.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace stereod {
namespace {

constexpr std::int64_t kMs = 1'000'000;

using Desk = Pairing<std::string>;

std::string take(Desk& desk) {
  const auto pair = desk.take();
  return pair ? pair->left + "+" + pair->right : "none";
}

TEST(Pairing, PairsFramesWithinTheTolerance) {
  Desk desk(16 * kMs);
  desk.add(Side::kLeft, "L0", 100 * kMs);
  EXPECT_FALSE(desk.has_pair());
  desk.add(Side::kRight, "R0", 116 * kMs);
  ASSERT_TRUE(desk.has_pair());
  const auto pair = desk.take();
  EXPECT_EQ(pair->left + pair->right, "L0R0");
  EXPECT_EQ(pair->skew_ns(), 16 * kMs);
  EXPECT_FALSE(desk.has_pair());
}

TEST(Pairing, SkewIsNegativeWhenTheRightFrameIsEarlier) {
  Desk desk(16 * kMs);
  desk.add(Side::kRight, "R0", 95 * kMs);
  desk.add(Side::kLeft, "L0", 100 * kMs);
  EXPECT_EQ(desk.take()->skew_ns(), -5 * kMs);
}

TEST(Pairing, DropsWhatCanNeverGetAPartner) {
  Desk desk(10 * kMs);
  desk.add(Side::kLeft, "L0", 0);
  desk.add(Side::kRight, "R0", 11 * kMs);  // too far from L0, and so is every later right frame
  EXPECT_EQ(desk.counts().left_without_partner, 1);
  desk.add(Side::kLeft, "L1", 15 * kMs);
  EXPECT_EQ(take(desk), "L1+R0");
  EXPECT_EQ(desk.counts().right_without_partner, 0);
}

TEST(Pairing, DropsALateFrameThatIsAlreadyTooOld) {
  Desk desk(10 * kMs);
  desk.add(Side::kLeft, "L1", 50 * kMs);
  desk.add(Side::kRight, "R0", 20 * kMs);
  EXPECT_EQ(desk.counts().right_without_partner, 1);
  desk.add(Side::kRight, "R1", 52 * kMs);
  EXPECT_EQ(take(desk), "L1+R1");
}

TEST(Pairing, OneCameraAloneNeverQueues) {
  Desk desk(10 * kMs);
  for (int i = 0; i < 10; ++i) desk.add(Side::kLeft, "L" + std::to_string(i), i * 33 * kMs);
  EXPECT_FALSE(desk.has_pair());
  EXPECT_EQ(desk.counts().left_without_partner, 9);
}

TEST(Pairing, ANewerPairSupersedesOneNotTaken) {
  Desk desk(10 * kMs);
  desk.add(Side::kLeft, "L0", 0);
  desk.add(Side::kRight, "R0", 1 * kMs);
  desk.add(Side::kLeft, "L1", 33 * kMs);
  desk.add(Side::kRight, "R1", 34 * kMs);
  EXPECT_EQ(take(desk), "L1+R1");
  EXPECT_EQ(desk.counts().pairs, 2);
  EXPECT_EQ(desk.counts().pairs_superseded, 1);
}

TEST(Pairing, ANearerFrameReplacesThePartnerOfAPairNotTaken) {
  Desk desk(20 * kMs);
  desk.add(Side::kRight, "R0", 0);
  desk.add(Side::kLeft, "L0", 18 * kMs);
  desk.add(Side::kRight, "R1", 20 * kMs);  // 2 ms from L0 instead of 18
  const auto pair = desk.take();
  EXPECT_EQ(pair->left + "+" + pair->right, "L0+R1");
  EXPECT_EQ(pair->skew_ns(), 2 * kMs);
  EXPECT_EQ(desk.counts().right_without_partner, 1);
  EXPECT_EQ(desk.counts().pairs, 1);
}

TEST(Pairing, AFartherFrameDoesNotReplaceThePartner) {
  Desk desk(20 * kMs);
  desk.add(Side::kRight, "R0", 0);
  desk.add(Side::kLeft, "L0", 5 * kMs);
  desk.add(Side::kRight, "R1", 20 * kMs);
  EXPECT_EQ(take(desk), "L0+R0");
  desk.add(Side::kLeft, "L1", 25 * kMs);
  EXPECT_EQ(take(desk), "L1+R1");
}

TEST(Pairing, FreeRunningCamerasOfOneRatePairEveryFrameWithItsNearest) {
  constexpr std::int64_t kPeriod = 33 * kMs;
  for (std::int64_t phase = 0; phase < kPeriod; phase += kMs) {
    Desk desk(kPeriod / 2);
    std::int64_t pairs = 0;
    for (int i = 0; i < 30; ++i) {
      desk.add(Side::kLeft, "L", i * kPeriod);
      pairs += desk.take() ? 1 : 0;
      desk.add(Side::kRight, "R", i * kPeriod + phase);
      if (const auto pair = desk.take()) {
        ++pairs;
        EXPECT_LE(std::abs(pair->skew_ns()), kPeriod / 2) << "phase " << phase;
      }
    }
    EXPECT_GE(pairs, 29) << "phase " << phase;
  }
}

TEST(Pairing, AClockThatGoesBackwardsStartsAnew) {
  Desk desk(10 * kMs);
  desk.add(Side::kLeft, "L0", 1000 * kMs);
  desk.add(Side::kLeft, "L1", 5 * kMs);
  EXPECT_EQ(desk.counts().frames_before_time_jump, 1);
  desk.add(Side::kRight, "R1", 6 * kMs);
  EXPECT_EQ(take(desk), "L1+R1");
}

TEST(Pairing, EveryFrameIsAccountedFor) {
  Desk desk(7 * kMs);
  std::uint64_t state = 1;
  std::int64_t now = 0;
  std::int64_t added = 0;
  std::int64_t taken = 0;
  for (int i = 0; i < 20'000; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const Side side = (state >> 40) % 2 == 0 ? Side::kLeft : Side::kRight;
    now += static_cast<std::int64_t>((state >> 33) % 12) * kMs - ((state >> 50) % 50 == 0 ? 200 * kMs : 0);
    desk.add(side, "x", now);
    ++added;
    if ((state >> 45) % 3 == 0 && desk.take()) ++taken;
  }
  if (desk.take()) ++taken;
  const PairingCounts& counts = desk.counts();
  const std::int64_t waiting = added - 2 * taken - 2 * counts.pairs_superseded - counts.left_without_partner -
                               counts.right_without_partner - counts.frames_before_time_jump;
  EXPECT_GE(waiting, 0);
  EXPECT_LE(waiting, 1);
  EXPECT_EQ(counts.pairs, taken + counts.pairs_superseded);
  EXPECT_GT(taken, 100);
}

TEST(Pairing, DroppedFramesAreGivenBackAtOnce) {
  Pairing<std::shared_ptr<int>> desk(10 * kMs);
  auto first = std::make_shared<int>(0);
  const std::weak_ptr<int> watch = first;
  desk.add(Side::kLeft, std::move(first), 0);
  EXPECT_FALSE(watch.expired());
  desk.add(Side::kLeft, std::make_shared<int>(1), 33 * kMs);
  EXPECT_TRUE(watch.expired());
  desk.clear();
  EXPECT_FALSE(desk.take());
}

}  // namespace
}  // namespace stereod
