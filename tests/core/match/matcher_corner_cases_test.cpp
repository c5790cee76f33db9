// SPDX-License-Identifier: BSD-3-Clause
// Corner cases of the matchers: ties, overflow, borders, thin bands, reused memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/match/band_matcher.h"
#include "core/match/frame_matcher.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/matcher_cases.h"
#include "tests/support/matcher_oracle.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

MatcherOptions options_with(int disparities, int window, Prefilter prefilter) {
  MatcherOptions options;
  options.disparities = disparities;
  options.window = window;
  options.prefilter = prefilter;
  return options;
}

/// All checks and filters of a band matcher; the texture check needs the prefilter.
MatcherOptions everything(int disparities, int window, Prefilter prefilter = Prefilter::kXsobel) {
  MatcherOptions options = options_with(disparities, window, prefilter);
  if (prefilter == Prefilter::kXsobel) options.texture_threshold = window * window;
  options.uniqueness_ratio = 5;
  options.left_right_max_diff = 1;
  options.median = 5;
  return options;
}

void expect_agreement(const StereoPair& pair, const MatcherOptions& options,
                      const std::vector<int>& workers = {1, 3}) {
  const DisparityImage oracle = oracle_match(pair.left.view(), pair.right.view(), options);
  for (const MatcherOptions& implementation : implementations_of(options)) {
    for (const int n : workers) EXPECT_TRUE(agrees(oracle, pair, {}, implementation, n));
  }
}

int valid_pixels(DisparityView image) {
  int valid = 0;
  for (int y = 0; y < image.height(); ++y) {
    valid += static_cast<int>(std::count_if(image.row(y), image.row(y) + image.width(),
                                            [](int d) { return d != kInvalidDisparity; }));
  }
  return valid;
}

TEST(MatcherCorners, Tie_LowestDisparityWins) {
  const StereoPair pair = random_pair(Content::kConstant, {70, 15}, 1);
  for (const Prefilter prefilter : {Prefilter::kNone, Prefilter::kXsobel}) {
    for (const int disparities : {1, 15, 16, 17, 33, 64}) {
      MatcherOptions options = options_with(disparities, 5, prefilter);
      options.min_disparity = 3;
      expect_agreement(pair, options);
      options.uniqueness_ratio = 1;
      expect_agreement(pair, options);
    }
  }
}

TEST(MatcherCorners, SumsBeyond16Bits_NoOverflow) {
  // 31 × 31 × 255 = 245055. The seeds give each pattern at least once.
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const StereoPair pair = random_pair(Content::kExtremes, {60, 34}, seed);
    for (const int window : {17, 31}) {
      expect_agreement(pair, options_with(40, window, Prefilter::kNone));
      MatcherOptions filtered = options_with(40, window, Prefilter::kXsobel);  // 31 × 31 × 126 = 121086
      filtered.prefilter_cap = 63;
      filtered.uniqueness_ratio = 100;
      filtered.texture_threshold = 63 * window * window;
      expect_agreement(pair, filtered);
    }
  }
}

TEST(MatcherCorners, SumsAroundPowersOfTwo_Agree) {
  // A kernel chooses its arithmetic by the maximum sum, window² × 2 × cap. Caps just below and just above
  // each limit, on content that comes close to that sum.
  for (const int window : {3, 5, 7, 9, 11, 13, 15, 17, 21, 23, 25, 31}) {
    for (int limit = 1 << 12; limit <= 1 << 16; limit *= 2) {
      const int above = (limit + 2 * window * window - 1) / (2 * window * window);
      for (const int cap : {above - 1, above, above + 1}) {
        if (cap < 1 || cap > 63) continue;
        MatcherOptions options = options_with(70, window, Prefilter::kXsobel);
        options.prefilter_cap = cap;
        options.uniqueness_ratio = cap % 2;
        for (std::uint64_t seed = 1; seed <= (kSanitized ? 3 : 12); ++seed) {
          expect_agreement(random_pair(Content::kExtremes, {window + 40, window}, seed), options, {1});
        }
      }
    }
  }
}

TEST(MatcherCorners, MoreDisparitiesThanColumns_Agree) {
  for (const int width : {9, 16, 31, 40}) {
    const StereoPair pair = random_pair(Content::kNoise, {width, 12}, 4);
    expect_agreement(pair, options_with(256, 5, Prefilter::kNone));
    expect_agreement(pair, everything(256, 5));
  }
}

TEST(MatcherCorners, MinDisparityBeyondImage_Agree) {
  const StereoPair pair = random_pair(Content::kNoise, {40, 12}, 5);
  for (const int min : {35, 36, 37, 39, 40, 41, 1024}) {
    MatcherOptions options = options_with(20, 5, Prefilter::kXsobel);
    options.min_disparity = min;
    expect_agreement(pair, options);
  }
}

TEST(MatcherCorners, WindowLargerThanImage_AllInvalid) {
  for (const Size size : {Size{30, 40}, Size{40, 30}, Size{5, 5}, Size{31, 1}, Size{1, 31}}) {
    const StereoPair pair = random_pair(Content::kNoise, size, 6);
    const MatcherOptions options = options_with(16, 31, Prefilter::kXsobel);
    ASSERT_EQ(valid_pixels(oracle_match(pair.left.view(), pair.right.view(), options).view()), 0);
    expect_agreement(pair, options);
    expect_agreement(pair, everything(16, 31));
  }
}

TEST(MatcherCorners, WindowEqualsImage_OnePixelValid) {
  const StereoPair pair = random_pair(Content::kNoise, {31, 31}, 7);
  const MatcherOptions options = options_with(16, 31, Prefilter::kXsobel);
  ASSERT_EQ(valid_pixels(oracle_match(pair.left.view(), pair.right.view(), options).view()), 1);
  expect_agreement(pair, options);
}

TEST(MatcherCorners, OnePixel_Agrees) {
  const StereoPair pair = random_pair(Content::kNoise, {1, 1}, 8);
  expect_agreement(pair, options_with(1, 3, Prefilter::kNone));
  expect_agreement(pair, everything(64, 11));
}

TEST(MatcherCorners, BandsThinnerThanHalo_Agree) {
  for (const int height : {11, 12, 17, 23}) {
    const StereoPair pair = random_pair(Content::kSlantedPair, {47, height}, 9);
    MatcherOptions options = everything(20, 11);
    expect_agreement(pair, options, {4, 8, height, height + 1, 40});
    options.speckle_size = 20;
    expect_agreement(pair, options, {8});
    options.median = 0;
    expect_agreement(pair, options, {8});
  }
}

/// Matches one band, writing up to @p ahead rows before they are pushed, and writes its disparities to @p
/// out.
testing::AssertionResult match_band(BandMatcher& matcher, const StereoPair& pair, RowRange band, int ahead,
                                    ImageView<std::int16_t> out) {
  const RowRange input = matcher.begin(band);
  if (input.first < 0 || input.end > out.height())
    return testing::AssertionFailure() << "wants rows not there";
  int next = band.first;
  for (int first = input.first; first < input.end; first += ahead) {
    const int end = std::min(input.end, first + ahead);
    for (int y = first; y < end; ++y) {
      std::copy_n(pair.left.row(y), pair.left.width(), matcher.left_row(y));
      std::copy_n(pair.right.row(y), pair.right.width(), matcher.right_row(y));
    }
    for (int y = first; y < end; ++y) {
      const RowRange final = matcher.push(y);
      if (final.count() <= 0) continue;
      if (final.first != next)
        return testing::AssertionFailure() << "row " << final.first << " in place of " << next;
      for (; next < final.end; ++next) std::copy_n(matcher.disparity_row(next), out.width(), out.row(next));
    }
  }
  if (next != band.end)
    return testing::AssertionFailure() << "rows end at " << next << ", not at " << band.end;
  return testing::AssertionSuccess();
}

/// Matches bands of any height, in any order, of several frames, with one band matcher.
void use_again_and_again(const MatcherOptions& options, Size size, Random& random) {
  const auto matcher = make_band_matcher(options, size);
  for (int frame = 0; frame < 6; ++frame) {
    const StereoPair pair = random_pair(random.one_of(kAllContents), size, random.next());
    const DisparityImage oracle = oracle_match(pair.left.view(), pair.right.view(), options);
    DisparityImage disparities(size);
    copy_pixels(oracle.view(), disparities.view());  // for the rows outside all bands
    for (int i = 0; i < 6; ++i) {
      const int first = random.between(0, size.height - 1);
      const RowRange band{first, random.between(first + 1, size.height)};
      const int ahead = random.between(1, BandMatcher::kRowsAhead);
      ASSERT_TRUE(match_band(*matcher, pair, band, ahead, disparities.view()))
          << band.first << " to " << band.end << ": " << describe(options);
      ASSERT_TRUE(same_disparities(oracle, disparities.view()))
          << "band " << band.first << " to " << band.end << ", " << ahead
          << " rows ahead: " << describe(options);
    }
  }
}

TEST(MatcherCorners, MatcherReused_EqualsFresh) {
  Random random(10);
  for (const int window : {3, 11, 19}) {
    for (const Prefilter prefilter : {Prefilter::kNone, Prefilter::kXsobel}) {
      for (const MatcherOptions& options : implementations_of(everything(24, window, prefilter))) {
        use_again_and_again(options, {61, 37}, random);
      }
    }
  }
}

TEST(MatcherCorners, BandAbandoned_LeavesNoTrace) {
  const Size size{50, 30};
  const StereoPair first = random_pair(Content::kNoise, size, 11);
  const StereoPair second = random_pair(Content::kSlantedPair, size, 12);
  for (const MatcherOptions& options : implementations_of(everything(24, 7))) {
    const auto matcher = make_band_matcher(options, size);
    const RowRange input = matcher->begin({0, size.height});
    for (int y = input.first; y < input.first + 17; ++y) {
      std::copy_n(first.left.row(y), size.width, matcher->left_row(y));
      std::copy_n(first.right.row(y), size.width, matcher->right_row(y));
      matcher->push(y);
    }
    DisparityImage disparities(size);
    ASSERT_TRUE(match_band(*matcher, second, {0, size.height}, 1, disparities.view()));
    EXPECT_TRUE(
        same_disparities(oracle_match(second.left.view(), second.right.view(), options), disparities.view()))
        << describe(options);
  }
}

TEST(MatcherCorners, Match_AllocatesNothing) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "allocations cannot be counted in this build";
  const Size size{90, 40};
  const StereoPair pair = random_pair(Content::kSlantedPair, size, 13);
  DisparityImage disparities(size);
  MatcherOptions all = everything(32, 9);
  all.speckle_size = 30;
  for (const MatcherOptions& options : implementations_of(all)) {
    FrameMatcher matcher(options, size, pool_of(3));
    const AllocationCounter counter;
    for (int frame = 0; frame < 5; ++frame)
      matcher.match(pair.left.view(), pair.right.view(), disparities.view());
    EXPECT_EQ(counter.count(), 0U) << describe(options);
  }
}

TEST(MatcherCorners, BadOptions_Throw) {
  MatcherOptions options;
  options.window = 4;
  EXPECT_THROW(FrameMatcher(options, {64, 48}, pool_of(1)), std::invalid_argument);
  EXPECT_THROW(make_band_matcher(options, {64, 48}), std::invalid_argument);
  try {
    make_band_matcher(options, {64, 48});
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(error.what(), to_string(problem_with(options).value()));
  }
}

TEST(MatcherCorners, BadImageSize_Throws) {
  const MatcherOptions options;
  EXPECT_NO_THROW(make_band_matcher(options, {32767, 8}));
  for (const Size size : {Size{32768, 8}, Size{8, 32768}, Size{0, 8}, Size{8, 0}}) {
    EXPECT_THROW(make_band_matcher(options, size), std::invalid_argument) << size.width << "×" << size.height;
  }
}

TEST(MatcherCorners, IsaAuto_Runs) {
  const std::vector<Isa>& isas = isas_that_run();
  EXPECT_NE(std::find(isas.begin(), isas.end(), Isa::kAuto), isas.end());
  EXPECT_NE(std::find(isas.begin(), isas.end(), Isa::kScalar), isas.end());
}

}  // namespace
}  // namespace stereod
