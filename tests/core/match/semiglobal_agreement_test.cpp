// SPDX-License-Identifier: BSD-3-Clause
// With random images, sizes, options, masks and bands the semi-global kernel, on every instruction set of
// this CPU, equals the reference.
//
// STEREOD_TEST_CASES and STEREOD_TEST_SEED as in matcher_agreement_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>

#include "core/match/band_matcher.h"
#include "core/match/frame_matcher.h"
#include "core/match/semiglobal/reference.h"
#include "tests/support/matcher_cases.h"
#include "tests/support/matcher_oracle.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

constexpr std::uint64_t kFirstSeed = 20'260'101;
constexpr std::uint64_t kCases = kSanitized ? 60 : 1'500;
constexpr int kFailuresShown = 5;

std::uint64_t number_from_environment(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

struct Case {
  Size size;
  MatcherOptions options;
  StereoPair pair, before;  // before: the pair matched before, or empty
  std::optional<ValidityMask> left_mask, right_mask;
};

Size random_size(Random& random) {
  switch (random.between(0, 7)) {
    case 0:
      return {random.between(1, 6), random.between(1, 6)};
    case 1:
      return {random.between(1, 4), random.between(1, 40)};
    case 2:
      return {random.between(1, 140), random.between(1, 3)};
    case 3:
      return {random.between(250, 420), random.between(1, 9)};
    default:
      return {random.between(1, 140), random.between(1, 40)};
  }
}

int random_disparities(Random& random) {
  constexpr std::array kSpecial = {1,  2,  15, 16, 17,  31,  32,  33,  48, 49,
                                   63, 64, 65, 96, 127, 128, 129, 255, 256};
  return random.one_in(2) ? random.one_of(kSpecial) : random.between(1, random.one_in(3) ? 256 : 70);
}

MatcherOptions random_options(Random& random) {
  MatcherOptions o;
  o.method = Method::kSemiglobal;
  o.grid = random.one_in(2) ? Grid::kFine : Grid::kCoarse;
  o.disparities = random_disparities(random);
  if (random.one_in(3)) o.min_disparity = random.between(0, random.one_in(10) ? 1024 : 40);
  if (random.one_in(2)) o.p1 = random.between(0, random.one_in(4) ? 255 : 30);
  if (random.one_in(2)) o.p2 = random.between(0, random.one_in(2) ? 255 : 80);
  if (random.one_in(3)) o.census_weight = random.between(0, 16);
  if (random.one_in(3)) o.gradient_limit = random.between(0, 64);
  o.prefilter_cap = random.one_in(2) ? 31 : random.between(1, 63);
  if (random.one_in(3)) o.uniqueness_ratio = random.between(1, random.one_in(3) ? 100 : 15);
  o.left_right_max_diff = random.one_in(4) ? random.between(-1, 255) : random.between(-1, 3);
  o.subpixel = !random.one_in(3);
  o.median = random.one_in(3) ? 0 : 3;
  o.hole_filling = random.one_in(2);
  if (random.one_in(4)) o.speckle_size = random.between(1, 200);
  o.speckle_max_diff = random.between(0, 2);
  return o;
}

std::optional<ValidityMask> random_mask(Random& random, Size size) {
  if (random.one_in(2)) return std::nullopt;
  const int left = random.between(0, size.width / 4);
  const int holes = random.between(2, 40);
  return ValidityMask(size, [&](int x, int y) { return x >= left && (y % 4 == 0 || !random.one_in(holes)); });
}

Case random_case(std::uint64_t seed) {
  Random random(seed);
  Case c;
  constexpr double kMaxWork = 400'000;  // pixels times disparities
  do {
    c.size = random_size(random);
    c.options = random_options(random);
  } while (1.0 * c.size.width * c.size.height * c.options.disparities > kMaxWork);
  const Content content = random.one_in(2) ? Content::kSlantedPair : random.one_of(kAllContents);
  c.pair = random_pair(content, c.size, random.next());
  if (random.one_in(2)) c.before = random_pair(random.one_of(kAllContents), c.size, random.next());
  c.left_mask = random_mask(random, c.size);
  c.right_mask = random_mask(random, c.size);
  return c;
}

const ValidityMask* pointer_to(const std::optional<ValidityMask>& mask) { return mask ? &*mask : nullptr; }

DisparityImage match_frame(const Case& c, const MatcherOptions& options, int workers) {
  DisparityImage found(c.size);
  FrameMatcher matcher(options, c.size, pool_of(workers));
  if (!c.before.left.empty()) matcher.match(c.before.left.view(), c.before.right.view(), found.view());
  matcher.use_masks(pointer_to(c.left_mask), pointer_to(c.right_mask));
  matcher.match(c.pair.left.view(), c.pair.right.view(), found.view());
  return found;
}

/// Matches bands from the bottom up with one matcher, as a worker of the daemon does: rows are written before
/// they are pushed.
DisparityImage match_bands(const Case& c, const MatcherOptions& options, int bands) {
  DisparityImage found(c.size);
  const std::unique_ptr<BandMatcher> matcher = make_band_matcher(options, c.size);
  matcher->use_masks(pointer_to(c.left_mask), pointer_to(c.right_mask));
  for (int band = bands - 1; band >= 0; --band) {
    const RowRange input = matcher->begin(band_rows(c.size.height, band, bands));
    for (int first = input.first; first < input.end; first += BandMatcher::kRowsAhead) {
      const int end = std::min(first + BandMatcher::kRowsAhead, input.end);
      for (int y = first; y < end; ++y) {
        std::copy_n(c.pair.left.row(y), c.size.width, matcher->left_row(y));
        std::copy_n(c.pair.right.row(y), c.size.width, matcher->right_row(y));
      }
      for (int y = first; y < end; ++y) {
        const RowRange done = matcher->push(y);
        for (int f = done.first; f < done.end; ++f) {
          std::copy_n(matcher->disparity_row(f), c.size.width, found.row(f));
        }
      }
    }
  }
  return found;
}

TEST(SemiglobalAgreement, EveryKernel_EqualsReference) {
  const std::uint64_t first_seed = number_from_environment("STEREOD_TEST_SEED", kFirstSeed);
  const std::uint64_t cases = number_from_environment("STEREOD_TEST_CASES", kCases);
  int failures = 0;
  std::uint64_t measured = 0;
  std::uint64_t filled = 0;
  for (std::uint64_t seed = first_seed; seed < first_seed + cases && failures < kFailuresShown; ++seed) {
    const Case c = random_case(seed);
    ASSERT_EQ(problem_with(c.options), std::nullopt);
    const DisparityImage unfiltered = semiglobal_reference(c.pair.left.view(), c.pair.right.view(), c.options,
                                                           pointer_to(c.left_mask), pointer_to(c.right_mask));
    const DisparityImage reference = oracle_speckle(unfiltered, c.options.speckle_size,
                                                    c.options.speckle_max_diff * c.options.units_per_pixel());
    for (int y = 0; y < c.size.height; ++y) {
      for (int x = 0; x < c.size.width; ++x) {
        measured += reference.at(x, y) >= 0 ? 1 : 0;
        filled += is_filled(reference.at(x, y)) ? 1 : 0;
      }
    }
    Random random(seed);
    for (const MatcherOptions& options : implementations_of(c.options)) {
      const int workers = random.between(1, 5);
      const int bands = random.between(1, std::min(c.size.height, 6));
      testing::AssertionResult same = same_disparities(reference, match_frame(c, options, workers).view());
      if (same) same = same_disparities(unfiltered, match_bands(c, options, bands).view());
      if (!same) ++failures;
      EXPECT_TRUE(same) << "  seed " << seed << ", " << c.size.width << "x" << c.size.height << ", "
                        << workers << " workers, " << bands << " bands, "
                        << (c.left_mask ? "left mask, " : "") << (c.right_mask ? "right mask, " : "")
                        << describe(options);
    }
  }
  if (cases >= 50) {
    EXPECT_GT(measured, 100 * cases) << "the cases are too easy";
    EXPECT_GT(filled, 30 * cases) << "the cases are too easy";
  }
}

TEST(SemiglobalAgreement, TightImages_StayInMemory) {
  MatcherOptions base;
  base.method = Method::kSemiglobal;
  base.left_right_max_diff = 1;
  base.median = 3;
  for (const Size size : {Size{1, 1}, Size{2, 1}, Size{1, 2}, Size{63, 17}, Size{64, 16}, Size{65, 15}}) {
    for (const int disparities : {1, 47, 64, 200}) {
      base.disparities = disparities;
      const StereoPair pair = random_pair(Content::kSlantedPair, size, 11);
      const DisparityImage reference =
          semiglobal_reference(pair.left.view(), pair.right.view(), base, nullptr, nullptr);
      for (const MatcherOptions& options : implementations_of(base)) {
        EXPECT_TRUE(agrees(reference, pair, {}, options, 2)) << describe(options);
      }
    }
  }
}

}  // namespace
}  // namespace stereod
