// SPDX-License-Identifier: BSD-3-Clause
#include "core/sync/pairing.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace stereod {
namespace {

constexpr std::int64_t kMs = 1'000'000;

using Desk = Pairing<std::string>;

std::string take(Desk& pair_queue) {
  const auto pair = pair_queue.take();
  return pair ? pair->left + "+" + pair->right : "none";
}

TEST(Pairing, WithinTolerance_Pairs) {
  Desk pair_queue(16 * kMs);
  pair_queue.add(Side::kLeft, "L0", 100 * kMs);
  EXPECT_FALSE(pair_queue.has_pair());
  pair_queue.add(Side::kRight, "R0", 116 * kMs);
  ASSERT_TRUE(pair_queue.has_pair());
  const auto pair = pair_queue.take();
  EXPECT_EQ(pair->left + pair->right, "L0R0");
  EXPECT_EQ(pair->skew_ns(), 16 * kMs);
  EXPECT_FALSE(pair_queue.has_pair());
}

TEST(Pairing, RightEarlier_SkewIsNegative) {
  Desk pair_queue(16 * kMs);
  pair_queue.add(Side::kRight, "R0", 95 * kMs);
  pair_queue.add(Side::kLeft, "L0", 100 * kMs);
  EXPECT_EQ(pair_queue.take()->skew_ns(), -5 * kMs);
}

TEST(Pairing, NoPossiblePartner_Drops) {
  Desk pair_queue(10 * kMs);
  pair_queue.add(Side::kLeft, "L0", 0);
  pair_queue.add(Side::kRight, "R0", 11 * kMs);  // too far from L0, and so is every later right frame
  EXPECT_EQ(pair_queue.counts().left_without_partner, 1);
  pair_queue.add(Side::kLeft, "L1", 15 * kMs);
  EXPECT_EQ(take(pair_queue), "L1+R0");
  EXPECT_EQ(pair_queue.counts().right_without_partner, 0);
}

TEST(Pairing, LateFrameTooOld_Drops) {
  Desk pair_queue(10 * kMs);
  pair_queue.add(Side::kLeft, "L1", 50 * kMs);
  pair_queue.add(Side::kRight, "R0", 20 * kMs);
  EXPECT_EQ(pair_queue.counts().right_without_partner, 1);
  pair_queue.add(Side::kRight, "R1", 52 * kMs);
  EXPECT_EQ(take(pair_queue), "L1+R1");
}

TEST(Pairing, OneCamera_NeverQueues) {
  Desk pair_queue(10 * kMs);
  for (int i = 0; i < 10; ++i) pair_queue.add(Side::kLeft, "L" + std::to_string(i), i * 33 * kMs);
  EXPECT_FALSE(pair_queue.has_pair());
  EXPECT_EQ(pair_queue.counts().left_without_partner, 9);
}

TEST(Pairing, NewerPair_SupersedesOlder) {
  Desk pair_queue(10 * kMs);
  pair_queue.add(Side::kLeft, "L0", 0);
  pair_queue.add(Side::kRight, "R0", 1 * kMs);
  pair_queue.add(Side::kLeft, "L1", 33 * kMs);
  pair_queue.add(Side::kRight, "R1", 34 * kMs);
  EXPECT_EQ(take(pair_queue), "L1+R1");
  EXPECT_EQ(pair_queue.counts().pairs, 2);
  EXPECT_EQ(pair_queue.counts().pairs_superseded, 1);
}

TEST(Pairing, NearerFrame_ReplacesPartner) {
  Desk pair_queue(20 * kMs);
  pair_queue.add(Side::kRight, "R0", 0);
  pair_queue.add(Side::kLeft, "L0", 18 * kMs);
  pair_queue.add(Side::kRight, "R1", 20 * kMs);  // 2 ms from L0 instead of 18
  const auto pair = pair_queue.take();
  EXPECT_EQ(pair->left + "+" + pair->right, "L0+R1");
  EXPECT_EQ(pair->skew_ns(), 2 * kMs);
  EXPECT_EQ(pair_queue.counts().right_without_partner, 1);
  EXPECT_EQ(pair_queue.counts().pairs, 1);
}

TEST(Pairing, FartherFrame_KeepsPartner) {
  Desk pair_queue(20 * kMs);
  pair_queue.add(Side::kRight, "R0", 0);
  pair_queue.add(Side::kLeft, "L0", 5 * kMs);
  pair_queue.add(Side::kRight, "R1", 20 * kMs);
  EXPECT_EQ(take(pair_queue), "L0+R0");
  pair_queue.add(Side::kLeft, "L1", 25 * kMs);
  EXPECT_EQ(take(pair_queue), "L1+R1");
}

TEST(Pairing, SameRate_PairsNearestFrames) {
  constexpr std::int64_t kPeriod = 33 * kMs;
  for (std::int64_t phase = 0; phase < kPeriod; phase += kMs) {
    Desk pair_queue(kPeriod / 2);
    std::int64_t pairs = 0;
    for (int i = 0; i < 30; ++i) {
      pair_queue.add(Side::kLeft, "L", i * kPeriod);
      pairs += pair_queue.take() ? 1 : 0;
      pair_queue.add(Side::kRight, "R", i * kPeriod + phase);
      if (const auto pair = pair_queue.take()) {
        ++pairs;
        EXPECT_LE(std::abs(pair->skew_ns()), kPeriod / 2) << "phase " << phase;
      }
    }
    EXPECT_GE(pairs, 29) << "phase " << phase;
  }
}

TEST(Pairing, ClockBackwards_StartsOver) {
  Desk pair_queue(10 * kMs);
  pair_queue.add(Side::kLeft, "L0", 1000 * kMs);
  pair_queue.add(Side::kLeft, "L1", 5 * kMs);
  EXPECT_EQ(pair_queue.counts().frames_before_time_jump, 1);
  pair_queue.add(Side::kRight, "R1", 6 * kMs);
  EXPECT_EQ(take(pair_queue), "L1+R1");
}

TEST(Pairing, EveryFrame_IsCounted) {
  Desk pair_queue(7 * kMs);
  std::uint64_t state = 1;
  std::int64_t now = 0;
  std::int64_t added = 0;
  std::int64_t taken = 0;
  for (int i = 0; i < 20'000; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const Side side = (state >> 40) % 2 == 0 ? Side::kLeft : Side::kRight;
    now += static_cast<std::int64_t>((state >> 33) % 12) * kMs - ((state >> 50) % 50 == 0 ? 200 * kMs : 0);
    pair_queue.add(side, "x", now);
    ++added;
    if ((state >> 45) % 3 == 0 && pair_queue.take()) ++taken;
  }
  if (pair_queue.take()) ++taken;
  const PairingCounts& counts = pair_queue.counts();
  const std::int64_t waiting = added - 2 * taken - 2 * counts.pairs_superseded - counts.left_without_partner -
                               counts.right_without_partner - counts.frames_before_time_jump;
  EXPECT_GE(waiting, 0);
  EXPECT_LE(waiting, 1);
  EXPECT_EQ(counts.pairs, taken + counts.pairs_superseded);
  EXPECT_GT(taken, 100);
}

TEST(Pairing, DroppedFrame_IsReleasedAtOnce) {
  Pairing<std::shared_ptr<int>> pair_queue(10 * kMs);
  auto first = std::make_shared<int>(0);
  const std::weak_ptr<int> watch = first;
  pair_queue.add(Side::kLeft, std::move(first), 0);
  EXPECT_FALSE(watch.expired());
  pair_queue.add(Side::kLeft, std::make_shared<int>(1), 33 * kMs);
  EXPECT_TRUE(watch.expired());
  pair_queue.clear();
  EXPECT_FALSE(pair_queue.take());
}

}  // namespace
}  // namespace stereod
