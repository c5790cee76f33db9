// SPDX-License-Identifier: BSD-3-Clause
// Pixels without a source in the camera image, or whose match has none, are invalid.
#include <gtest/gtest.h>

#include <vector>

#include "core/match/frame_matcher.h"
#include "tests/support/matcher_cases.h"
#include "tests/support/matcher_oracle.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

constexpr Size kSize{131, 23};

MatcherOptions options_with(int min_disparity, int disparities) {
  MatcherOptions options;
  options.min_disparity = min_disparity;
  options.disparities = disparities;
  options.window = 5;
  options.subpixel = false;
  return options;
}

/// A mask with whole rows, rows with a border, and rows with random holes.
ValidityMask mask_of(std::uint64_t seed) {
  Random random(seed);
  return {kSize, [&](int x, int y) {
            if (y % 3 == 0) return true;
            return y % 3 == 1 ? x > 10 + y && x < 120 : random.between(0, 9) > 0;
          }};
}

DisparityImage match(const StereoPair& pair, const MatcherOptions& options, const ValidityMask* left,
                     const ValidityMask* right, int workers) {
  FrameMatcher matcher(options, kSize, pool_of(workers));
  matcher.use_masks(left, right);
  DisparityImage out(kSize);
  matcher.match(pair.left.view(), pair.right.view(), out.view());
  return out;
}

TEST(MatcherMask, NoSource_InvalidatesPixelAndMatch) {
  const ValidityMask left = mask_of(1);
  const ValidityMask right = mask_of(2);
  for (const MatcherOptions& base : {options_with(0, 20), options_with(7, 33)}) {
    const StereoPair pair = random_pair(Content::kSlantedPair, kSize, 5);
    DisparityImage expected = oracle_match(pair.left.view(), pair.right.view(), base);
    int masked = 0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        std::int16_t& d = expected.at(x, y);
        if (d == kInvalidDisparity || (left.row(y)[x] != 0 && right.row(y)[x - d] != 0)) continue;
        d = kInvalidDisparity;
        ++masked;
      }
    }
    ASSERT_GT(masked, 100);
    for (const MatcherOptions& options : implementations_of(base)) {
      for (const int workers : {1, 3}) {
        EXPECT_TRUE(same_disparities(expected, match(pair, options, &left, &right, workers).view()))
            << describe(options) << ", " << workers << " workers";
      }
    }
  }
}

TEST(MatcherMask, Removed_HasNoEffect) {
  const StereoPair pair = random_pair(Content::kSlantedPair, kSize, 6);
  const MatcherOptions options = options_with(0, 20);
  const ValidityMask nothing(kSize, [](int, int) { return false; });
  FrameMatcher matcher(options, kSize, pool_of(1));
  DisparityImage out(kSize);
  matcher.use_masks(&nothing, &nothing);
  matcher.match(pair.left.view(), pair.right.view(), out.view());
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) ASSERT_EQ(out.at(x, y), kInvalidDisparity);
  }
  matcher.use_masks(nullptr, nullptr);
  matcher.match(pair.left.view(), pair.right.view(), out.view());
  EXPECT_TRUE(same_disparities(oracle_match(pair.left.view(), pair.right.view(), options), out.view()));
}

}  // namespace
}  // namespace stereod
