// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/row_stage.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace stereod {
namespace {

TEST(RowRing, Capacity_KeepsLastRows) {
  RowRing<std::int16_t> ring(5, 3);
  for (int y = 0; y < 7; ++y) ring.row(y)[4] = static_cast<std::int16_t>(y);
  for (int y = 4; y < 7; ++y) EXPECT_EQ(ring.row(y)[4], y);
  EXPECT_EQ(ring.row(3), ring.row(6));
}

TEST(RowRing, Margin_IsWritableOnBothSides) {
  RowRing<std::uint8_t> ring(10, 2, 4);
  ring.fill(7);
  ring.row(0)[-4] = 1;
  ring.row(0)[13] = 2;
  EXPECT_EQ(ring.row(1)[-4], 7);
  EXPECT_EQ(ring.row(1)[13], 7);
}

TEST(RowStage, Border_GrowsRowsWithinImage) {
  RowStage stage(2);
  EXPECT_EQ(stage.begin({10, 20}, {0, 100}), (RowRange{8, 22}));
  EXPECT_EQ(stage.begin({0, 20}, {0, 21}), (RowRange{0, 21}));
  EXPECT_EQ(stage.begin({1, 3}, {5, 95}), (RowRange{5, 5}));  // reads no row that exists
}

TEST(RowStage, Scale_ReadsEverySecondRow) {
  RowStage stage(2, 2);
  EXPECT_EQ(stage.begin({3, 5}, {0, 100}), (RowRange{4, 11}));  // rows 6 and 8, two above and below
  EXPECT_EQ(stage.begin({0, 5}, {0, 9}), (RowRange{0, 9}));
}

/// Returns how many rows the stage has made after each row of its input.
std::vector<int> made_after_each(RowStage stage, RowRange rows, RowRange available, int at_once = 1) {
  const RowRange input = stage.begin(rows, available);
  std::vector<int> made;
  for (int y = input.first; y < input.end; ++y) {
    while (stage.ready(y + 1, at_once)) {
      for (int i = 0; i < at_once && stage.made_end() < stage.end(); ++i) stage.take();
    }
    made.push_back(stage.made_end() - rows.first);
  }
  return made;
}

TEST(RowStage, Ready_WaitsForTheBorderBelow) {
  EXPECT_EQ(made_after_each(RowStage(1), {4, 7}, {0, 100}), (std::vector{0, 0, 1, 2, 3}));
  EXPECT_EQ(made_after_each(RowStage(0), {4, 7}, {0, 100}), (std::vector{1, 2, 3}));
  EXPECT_EQ(made_after_each(RowStage(1, 2), {1, 3}, {0, 100}), (std::vector{0, 0, 1, 1, 2}));
}

TEST(RowStage, ReadyAtImageEnd_MakesAllRows) {
  EXPECT_EQ(made_after_each(RowStage(2), {6, 10}, {0, 10}), (std::vector{0, 0, 0, 0, 1, 4}));
}

TEST(RowStage, ReadyForTwo_WaitsForBoth) {
  EXPECT_EQ(made_after_each(RowStage(1), {4, 8}, {0, 100}, 2), (std::vector{0, 0, 0, 2, 2, 4}));
  EXPECT_EQ(made_after_each(RowStage(1), {4, 7}, {0, 100}, 2), (std::vector{0, 0, 0, 2, 3}));
}

TEST(RowStage, RowsBeforeInput_AreReadyAtOnce) {
  RowStage stage(1);
  const RowRange input = stage.begin({0, 8}, {3, 90});
  EXPECT_EQ(input, (RowRange{3, 9}));
  int made = 0;
  while (stage.ready(input.first)) stage.take(), ++made;
  EXPECT_EQ(made, 3);
}

TEST(RowStage, WithoutInput_MakesAllRowsAtOnce) {
  RowStage stage(1);
  stage.begin_without_input({5, 9});
  EXPECT_TRUE(stage.input().empty());
  while (stage.ready(5)) stage.take();
  EXPECT_EQ(stage.made_end(), 9);
}

TEST(RowNeighbors, BeyondTheImage_MirroredOrClamped) {
  EXPECT_EQ(mirrored_row(-1, 5), 1);
  EXPECT_EQ(mirrored_row(5, 5), 3);
  EXPECT_EQ(mirrored_row(2, 5), 2);
  EXPECT_EQ(mirrored_row(-1, 1), 0);
  EXPECT_EQ(mirrored_row(1, 1), 0);
  EXPECT_EQ(clamped_row(-2, 5), 0);
  EXPECT_EQ(clamped_row(6, 5), 4);
}

TEST(Interval, Grown_IsClipped) {
  EXPECT_EQ(grown({3, 5}, 2, {2, 6}), (Interval{2, 6}));
  EXPECT_TRUE(grown({0, 2}, 1, {5, 9}).empty());
  EXPECT_TRUE((Interval{3, 5}).contains(4));
  EXPECT_FALSE((Interval{3, 5}).contains(5));
}

}  // namespace
}  // namespace stereod
