// SPDX-License-Identifier: BSD-3-Clause
// Tests the oracle itself with cases computed by hand. Unless stated otherwise, windows are 3×3 and images
// are three equal rows, so only row 1 has disparities and every cost is three times that of a row.
#include "tests/support/matcher_oracle.h"

#include <gtest/gtest.h>

#include <vector>

namespace stereod {
namespace {

using Row = std::vector<int>;

GrayImage image_of(const std::vector<Row>& rows) {
  GrayImage image(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      image.at(x, y) =
          static_cast<std::uint8_t>(rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]);
    }
  }
  return image;
}

GrayImage three_rows(const Row& row) { return image_of({row, row, row}); }

DisparityImage disparity_image(const std::vector<Row>& rows) {
  DisparityImage image(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      image.at(x, y) =
          static_cast<std::int16_t>(rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]);
    }
  }
  return image;
}

template <typename Pixel>
std::vector<Row> rows_of(const Image<Pixel>& image) {
  std::vector<Row> rows;
  rows.reserve(static_cast<std::size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y) rows.emplace_back(image.row(y), image.row(y) + image.width());
  return rows;
}

/// Raw gray values, window 3, whole pixels, no check and no filter.
MatcherOptions plain(int disparities) {
  MatcherOptions options;
  options.disparities = disparities;
  options.window = 3;
  options.prefilter = Prefilter::kNone;
  options.subpixel = false;
  return options;
}

/// Returns the disparities of row 1 of two images of three equal rows.
Row answers(const Row& left, const Row& right, const MatcherOptions& options) {
  return rows_of(oracle_match(three_rows(left).view(), three_rows(right).view(), options))[1];
}

TEST(MatcherOracle, Prefilter_IsClippedSobel) {
  MatcherOptions options;
  options.prefilter_cap = 20;
  // At (1, 0) rows −1 and 1 are the same: S(−1) = S(1) = 9 − 4 = 5, S(0) = 3 − 1 = 2, g = 5 + 4 + 5 = 14.
  // At (1, 1): 2 + 10 + S(2) = 2 + 10 + (0 − 50) = −38, clipped to −20.
  // At (1, 2) row 3 is row 1: 5 − 100 + 5 = −90, clipped. Column 2 by the same rule:
  //   (2, 0): 2·(7 − 4) + 2·(2 − 1) = 8;  (2, 1): 1 + 6 + (7 − 50) = −36;  (2, 2): 3 − 86 + 3 = −80.
  // Columns 0 and 3 are the cap.
  const GrayImage image = image_of({{1, 1, 3, 2}, {4, 4, 9, 7}, {50, 50, 0, 7}});
  EXPECT_EQ(rows_of(oracle_prefilter(image.view(), options)),
            (std::vector<Row>{{20, 34, 21 + 7, 20}, {20, 0, 0, 20}, {20, 0, 0, 20}}));
}

TEST(MatcherOracle, PrefilterOneRow_UsesRowThrice) {
  MatcherOptions options;
  options.prefilter_cap = 63;
  EXPECT_EQ(rows_of(oracle_prefilter(image_of({{10, 0, 12, 200}}).view(), options)),
            (std::vector<Row>{{63, 63 + 4 * 2, 63 + 63, 63}}));
  EXPECT_EQ(rows_of(oracle_prefilter(image_of({{10}}).view(), options)), (std::vector<Row>{{63}}));
}

TEST(MatcherOracle, PrefilterTwoRows_MirrorsRows) {
  MatcherOptions options;
  options.prefilter_cap = 63;
  // Row 0: 2·S(1) + 2·S(0) = 2·3 + 2·1; row 1 the same.
  EXPECT_EQ(rows_of(oracle_prefilter(image_of({{0, 9, 1}, {0, 9, 3}}).view(), options)),
            (std::vector<Row>{{63, 71, 63}, {63, 71, 63}}));
}

TEST(MatcherOracle, LeftBorder_ShortensSearch) {
  // The left image is the right one moved by one pixel; |difference| is 10 at d = 0 and at d = 2, 0 at d
  // = 1. x = 1 has only k = 0 (n = 1 − 0 − 1 + 1); from x = 2 on d = 1 is searched. The rim of one pixel is
  // invalid.
  const Row left = {10, 20, 30, 40, 50, 60};
  const Row right = {20, 30, 40, 50, 60, 70};
  EXPECT_EQ(answers(left, right, plain(3)), (Row{-1, 0, 1, 1, 1, -1}));
  const DisparityImage whole = oracle_match(three_rows(left).view(), three_rows(right).view(), plain(3));
  EXPECT_EQ(rows_of(whole)[0], Row(6, -1));
  EXPECT_EQ(rows_of(whole)[2], Row(6, -1));
}

TEST(MatcherOracle, MinDisparity_MovesSearch) {
  // As above, so every d ≥ 1 gets worse by 10 a pixel: the lowest one searched wins. x − 2 − 1 ≥ 0 from x
  // = 3.
  MatcherOptions options = plain(3);
  options.min_disparity = 2;
  EXPECT_EQ(answers({10, 20, 30, 40, 50, 60}, {20, 30, 40, 50, 60, 70}, options),
            (Row{-1, -1, -1, 2, 2, -1}));
}

TEST(MatcherOracle, Tie_LowestDisparityWins) {
  EXPECT_EQ(answers(Row(6, 7), Row(6, 200), plain(4)), (Row{-1, 0, 0, 0, 0, -1}));
}

TEST(MatcherOracle, WindowLargerThanImage_AllInvalid) {
  MatcherOptions options = plain(2);
  options.window = 5;
  EXPECT_EQ(answers(Row(6, 7), Row(6, 7), options), Row(6, -1));
}

TEST(MatcherOracle, Costs_AreSadSsdMad) {
  // x = 2 sees k = 0 and 1 (n = 2 − 0 − 1 + 1). Differences in a row, first pair of images:
  //   k = 0: 0 0 9   sum 9, squares 81, maximum 9;   k = 1: 4 4 4   sum 12, squares 48, maximum 4.
  // Second pair:
  //   k = 0: 0 0 6   sum 6, squares 36, maximum 6;   k = 1: 5 5 5   sum 15, squares 75, maximum 5.
  const auto winner = [](const Row& left, const Row& right, Cost cost) {
    MatcherOptions options = plain(2);
    options.cost = cost;
    return answers(left, right, options)[2];
  };
  const Row left_1 = {0, 50, 54, 58}, right_1 = {54, 50, 54, 67};
  EXPECT_EQ(winner(left_1, right_1, Cost::kSad), 0);
  EXPECT_EQ(winner(left_1, right_1, Cost::kSsd), 1);
  EXPECT_EQ(winner(left_1, right_1, Cost::kMad), 1);
  const Row left_2 = {0, 50, 55, 60}, right_2 = {55, 50, 55, 66};
  EXPECT_EQ(winner(left_2, right_2, Cost::kSad), 0);
  EXPECT_EQ(winner(left_2, right_2, Cost::kSsd), 0);
  EXPECT_EQ(winner(left_2, right_2, Cost::kMad), 1);
}

TEST(MatcherOracle, Subpixel_IsVertexOfTwoLines) {
  MatcherOptions options = plain(3);
  options.subpixel = true;
  // On ramps of 8 a column, left = right − 10 gives a pixel differences |8d − 10|: 10, 2, 6.
  // a = 90, m = 18, b = 54: f = 8·36 / 72 = 4, so 16 + 4. At x = 2 the winner is the last of two: f = 0.
  EXPECT_EQ(answers({10, 18, 26, 34, 42}, {20, 28, 36, 44, 52}, options), (Row{-1, 0, 16, 20, -1}));
}

TEST(MatcherOracle, Subpixel_RoundsHalvesAwayFromZero) {
  MatcherOptions options = plain(3);
  options.subpixel = true;
  // Ramps of 32 a column. Differences 33, 1, 31: f = 8·(297 − 279) / (297 − 9) = 0.5, so 1.
  EXPECT_EQ(answers({7, 39, 71, 103, 135}, {40, 72, 104, 136, 168}, options)[3], 17);
  // Differences 31, 1, 33: f = −0.5, so −1.
  EXPECT_EQ(answers({9, 41, 73, 105, 137}, {40, 72, 104, 136, 168}, options)[3], 15);
}

TEST(MatcherOracle, Subpixel_ReachesHalfPixel) {
  MatcherOptions options = plain(3);
  options.subpixel = true;
  // Ramps of 10 a column. Differences 15, 5, 5: d = 1 wins the tie, f = 8·(135 − 45) / (135 − 45) = 8.
  EXPECT_EQ(answers({10, 20, 30, 40, 50}, {25, 35, 45, 55, 65}, options)[3], 24);
}

TEST(MatcherOracle, Texture_SumsClippedGradient) {
  // g = 4·2 = 8 in columns 1 to 3, and nothing in the columns 0 and 4: sums of 48, 72 and 48.
  const Row ramp = {0, 1, 2, 3, 4};
  MatcherOptions options = plain(1);
  options.prefilter = Prefilter::kXsobel;
  const auto with_threshold = [&](int threshold) {
    options.texture_threshold = threshold;
    return answers(ramp, ramp, options);
  };
  EXPECT_EQ(with_threshold(48), (Row{-1, 0, 0, 0, -1}));
  EXPECT_EQ(with_threshold(49), (Row{-1, -1, 0, -1, -1}));
  EXPECT_EQ(with_threshold(72), (Row{-1, -1, 0, -1, -1}));
  EXPECT_EQ(with_threshold(73), Row(5, -1));
  options.prefilter_cap = 5;  // 9 × 5 = 45
  EXPECT_EQ(with_threshold(45)[2], 0);
  EXPECT_EQ(with_threshold(46)[2], -1);
}

TEST(MatcherOracle, Uniqueness_RejectsRival) {
  // At x = 4, left 10 50 90. k = 0: 10 50 100, cost 3·10 = 30; k = 1: 101 10 50, cost 3·171; k = 2: 50 101
  // 10, cost 3·171; k = 3: 10 50 101, cost 3·11 = 33. 33 ≤ 30 + 30·10/100, but 33 > 30 + 30·9/100 = 32.
  const Row left = {0, 0, 0, 10, 50, 90};
  const Row right = {10, 50, 101, 10, 50, 100};
  MatcherOptions options = plain(4);
  EXPECT_EQ(answers(left, right, options)[4], 0);
  options.uniqueness_ratio = 9;
  EXPECT_EQ(answers(left, right, options)[4], 0);
  options.uniqueness_ratio = 10;
  EXPECT_EQ(answers(left, right, options)[4], -1);
}

TEST(MatcherOracle, Uniqueness_IgnoresNeighbors) {
  // Ramps: differences 15, 5, 5, 15. k = 2 is as good as k = 1 but beside it; the cost of k = 3 is too high.
  MatcherOptions options = plain(4);
  options.uniqueness_ratio = 100;
  EXPECT_EQ(answers({10, 20, 30, 40, 50, 60}, {25, 35, 45, 55, 65, 75}, options)[4], 1);
}

TEST(MatcherOracle, LeftRight_KeepsBestMatch) {
  // Winners: x = 1, 2, 3, 7: k = 0 at cost 0. x = 4 (9 0 9): k = 0, cost 27, matches 4. x = 5 (0 9 0): k = 2
  // at cost 0, matches 3. x = 6 (9 0 0): k = 2 at cost 0, matches 4. Right pixel 3: x = 3 and x = 5 at equal
  // cost, so x = 3 is its best match and x = 5 fails. Right pixel 4: x = 6 is its best match, x = 4 fails.
  const Row left = {0, 0, 0, 9, 0, 9, 0, 0, 0};
  const Row right = {0, 0, 0, 9, 0, 0, 0, 0, 0};
  MatcherOptions options = plain(3);
  EXPECT_EQ(answers(left, right, options), (Row{-1, 0, 0, 0, 0, 2, 2, 0, -1}));
  options.left_right_max_diff = 2;
  EXPECT_EQ(answers(left, right, options), (Row{-1, 0, 0, 0, 0, 2, 2, 0, -1}));
  options.left_right_max_diff = 1;
  EXPECT_EQ(answers(left, right, options), (Row{-1, 0, 0, 0, -1, -1, 2, 0, -1}));
}

TEST(MatcherOracle, LeftRight_CountsRejectedMatches) {
  // x = 4 (0 9 0) costs 0 at k = 0 and at k = 3: not unique. x = 6 (0 9 0) costs 0 only at k = 2. Both match
  // the right pixel 4, whose best match is x = 4, rejected or not.
  const Row left = {0, 0, 0, 0, 9, 0, 9, 0, 0, 0};
  const Row right = {0, 9, 0, 0, 9, 0, 0, 0, 0, 0};
  MatcherOptions options = plain(4);
  options.uniqueness_ratio = 1;
  options.left_right_max_diff = 2;
  EXPECT_EQ(answers(left, right, options)[4], -1);
  EXPECT_EQ(answers(left, right, options)[6], 2);
  options.left_right_max_diff = 1;
  EXPECT_EQ(answers(left, right, options)[4], -1);
  EXPECT_EQ(answers(left, right, options)[6], -1);
}

TEST(MatcherOracle, Median_IsLowerOfValid) {
  // (0, 0): 1 5 7 9 → 5. (1, 0): 1 5 7 8 9 → 7. (2, 0): 5 8 9 → 8, without the invalid one. (0, 1): as (0,
  // 0). (1, 1): 1 5 7 8 9 → 7. (2, 1): stays invalid.
  EXPECT_EQ(rows_of(oracle_median(disparity_image({{1, 9, 8}, {7, 5, -1}}), 3)),
            (std::vector<Row>{{5, 7, 8}, {5, 7, -1}}));
  // 5×5 over a single row: 1 2 9 → 2; 1 2 9 3 → 2; 1 2 9 3 4 → 3; 2 9 3 4 → 3; 9 3 4 → 4.
  EXPECT_EQ(rows_of(oracle_median(disparity_image({{1, 2, 9, 3, 4}}), 5)),
            (std::vector<Row>{{2, 2, 3, 3, 4}}));
}

TEST(MatcherOracle, Speckle_JoinsOverEdgesOnly) {
  // Regions at a difference of 1: {0 1 2 of row 0, and the 2 below it} = 4 pixels connected by small steps;
  // the 9 in row 0; the 9 in row 1, which touches it only at a corner; and 5.
  const DisparityImage image = disparity_image({{0, 1, 2, 9}, {5, -1, 2, -1}, {-1, 9, -1, 9}});
  EXPECT_EQ(rows_of(oracle_speckle(image, 1, 1)),
            (std::vector<Row>{{0, 1, 2, -1}, {-1, -1, 2, -1}, {-1, -1, -1, -1}}));
  EXPECT_EQ(rows_of(oracle_speckle(image, 3, 1))[0], (Row{0, 1, 2, -1}));
  EXPECT_EQ(rows_of(oracle_speckle(image, 4, 1))[0], Row(4, -1));
  // At a difference of 0 only the two 2s are connected.
  EXPECT_EQ(rows_of(oracle_speckle(image, 1, 0)),
            (std::vector<Row>{{-1, -1, 2, -1}, {-1, -1, 2, -1}, {-1, -1, -1, -1}}));
}

TEST(MatcherOracle, SpeckleDifference_IsInPixels) {
  // Disparities 0, 16, 16 + 4 (see Subpixel_IsVertexOfTwoLines): 16 units are one pixel, so all are
  // connected.
  MatcherOptions options = plain(3);
  options.subpixel = true;
  options.speckle_size = 2;
  const Row left = {10, 18, 26, 34, 42}, right = {20, 28, 36, 44, 52};
  EXPECT_EQ(answers(left, right, options), (Row{-1, 0, 16, 20, -1}));
  options.speckle_max_diff = 0;
  EXPECT_EQ(answers(left, right, options), Row(5, -1));
}

}  // namespace
}  // namespace stereod
