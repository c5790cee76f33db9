// SPDX-License-Identifier: BSD-3-Clause
// With random images, sizes and options every implementation, on every instruction set of this CPU, equals
// the oracle.
//
// STEREOD_TEST_CASES sets the number of cases, STEREOD_TEST_SEED the seed of the first. Each case has a seed
// of its own, printed on failure: STEREOD_TEST_SEED=<seed> STEREOD_TEST_CASES=1 repeats it alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <tuple>

#include "tests/support/matcher_cases.h"
#include "tests/support/matcher_oracle.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

constexpr std::uint64_t kFirstSeed = 20'130'501;
constexpr std::uint64_t kCases = kSanitized ? 300 : 10'000;
constexpr int kFailuresShown = 5;

std::uint64_t number_from_environment(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

struct Case {
  Size size;
  MatcherOptions options;
  Content content = Content::kNoise;
};

Size random_size(Random& random, int window) {
  constexpr std::array kPrimes = {2, 3, 5, 7, 13, 17, 31, 37, 53, 61, 83, 89};
  switch (random.between(0, 9)) {
    case 0:
      return {random.between(1, 6), random.between(1, 6)};
    case 1:
      return {random.between(1, 4), random.between(1, 60)};
    case 2:
      return {random.between(1, 90), random.between(1, 4)};
    case 3:
      return {random.one_of(kPrimes), random.one_of(kPrimes)};
    case 4:
      return {window + random.between(-1, 3), window + random.between(-1, 3)};  // room for few disparities
    case 5:
    case 6:
      return {random.between(150, 420), window + random.between(0, 6)};  // room for many disparities
    default:
      return {random.between(1, 90), random.between(1, 60)};
  }
}

int random_disparities(Random& random) {
  constexpr std::array kSpecial = {1, 2, 3, 15, 16, 17, 32, 48, 64, 65, 127, 128, 129, 240, 255, 256};
  switch (random.between(0, 3)) {
    case 0:
      return random.between(1, 16);
    case 1:
      return random.between(1, 256);
    case 2:
      return random.between(1, 64);
    default:
      return random.one_of(kSpecial);
  }
}

int random_min_disparity(Random& random) {
  if (random.one_in(2)) return 0;
  return random.one_in(20) ? random.between(0, 1024) : random.between(0, 40);
}

MatcherOptions random_options(Random& random) {
  MatcherOptions options;
  options.min_disparity = random_min_disparity(random);
  options.disparities = random_disparities(random);
  options.window = 2 * (random.one_in(2) ? random.between(1, 6) : random.between(1, 15)) + 1;
  if (random.one_in(12)) options.cost = random.one_in(2) ? Cost::kSsd : Cost::kMad;
  options.prefilter = random.one_in(3) ? Prefilter::kNone : Prefilter::kXsobel;
  options.prefilter_cap = random.one_in(2) ? 31 : random.between(1, 63);
  options.subpixel = random.one_in(2);
  if (options.prefilter == Prefilter::kXsobel && random.one_in(3)) {
    options.texture_threshold = random.between(1, options.prefilter_cap * options.window * options.window);
  }
  if (random.one_in(2))
    options.uniqueness_ratio = random.one_in(2) ? random.between(1, 15) : random.between(1, 100);
  if (random.one_in(2))
    options.left_right_max_diff = random.one_in(4) ? random.between(0, 255) : random.between(0, 3);
  options.median = random.one_of(std::array{0, 0, 3, 5});
  if (random.one_in(3))
    options.speckle_size = random.one_in(2) ? random.between(1, 10) : random.between(1, 400);
  options.speckle_max_diff = random.one_in(8) ? random.between(0, 255) : random.between(0, 2);
  return options;
}

/// Returns the approximate number of differences that the oracle computes.
double oracle_work(const Case& c) {
  const int columns = std::max(0, c.size.width - c.options.window + 1);
  const int rows = std::max(0, c.size.height - c.options.window + 1);
  return 1.0 * columns * rows * std::min(c.options.disparities, columns) * c.options.window *
         c.options.window;
}

/// Returns a case whose oracle takes a few milliseconds, sometimes a few dozen.
Case random_case(Random& random) {
  const double limit = random.one_in(25) ? 50e6 : 4e6;
  while (true) {
    Case c;
    c.options = random_options(random);
    c.size = random_size(random, c.options.window);
    c.content = random.one_in(3) ? Content::kSlantedPair : random.one_of(kAllContents);
    if (oracle_work(c) <= limit) return c;
  }
}

TEST(MatcherAgreement, EveryImplementation_EqualsOracle) {
  const std::uint64_t first_seed = number_from_environment("STEREOD_TEST_SEED", kFirstSeed);
  const std::uint64_t cases = number_from_environment("STEREOD_TEST_CASES", kCases);
  int failures = 0;
  std::uint64_t valid_pixels = 0;
  for (std::uint64_t seed = first_seed; seed < first_seed + cases && failures < kFailuresShown; ++seed) {
    Random random(seed);
    const Case c = random_case(random);
    ASSERT_EQ(problem_with(implementations_of(c.options).front()), std::nullopt);
    const StereoPair pair = random_pair(c.content, c.size, random.next());
    StereoPair before;
    if (random.one_in(2)) before = random_pair(random.one_of(kAllContents), c.size, random.next());

    const DisparityImage oracle = oracle_match(pair.left.view(), pair.right.view(), c.options);
    for (int y = 0; y < oracle.height(); ++y) {
      valid_pixels += static_cast<std::uint64_t>(
          std::count_if(oracle.row(y), oracle.row(y) + oracle.width(), [](int d) { return d >= 0; }));
    }
    for (const MatcherOptions& options : implementations_of(c.options)) {
      const testing::AssertionResult same = agrees(oracle, pair, before, options, random.between(1, 5));
      if (!same) ++failures;
      EXPECT_TRUE(same) << "  seed " << seed << ", " << c.size.width << "x" << c.size.height << ", "
                        << name_of(c.content) << (before.left.empty() ? "" : ", after another frame");
    }
  }
  if (cases >= 100) {
    EXPECT_GT(valid_pixels, 100 * cases) << "the cases are too easy: few pixels have a disparity";
  }
  std::string isas;
  for (const Isa isa : isas_that_run()) isas.append(" ").append(name_of(isa));
  RecordProperty("instruction_sets", isas);
}

// A kernel holds disparities in vectors and chunks of 32 to 64; the layout of the last ones depends on their
// number alone.
TEST(MatcherAgreement, EveryDisparityCount_EqualsOracle) {
  Random random(kFirstSeed);
  const int step = kSanitized || std::getenv("STEREOD_TEST_CASES") != nullptr ? 7 : 1;
  for (int disparities = 1; disparities <= 131 && !testing::Test::HasFailure(); disparities += step) {
    Case c;
    c.options.disparities = disparities;
    c.options.subpixel = true;
    c.options.uniqueness_ratio = 10;
    for (const auto& [prefilter, cap, window] : {
             std::tuple{Prefilter::kXsobel, 31, 5},   // packed with the number of the group
             std::tuple{Prefilter::kXsobel, 63, 11},  // packed in halves
             std::tuple{Prefilter::kNone, 31, 7},     // raw
             std::tuple{Prefilter::kNone, 31, 17},    // wide
         }) {
      c.options.prefilter = prefilter;
      c.options.prefilter_cap = cap;
      c.options.window = window;
      const Size size{window + random.between(disparities / 2, disparities + 40), window + 1};
      const StereoPair pair = random_pair(random.one_of(kAllContents), size, random.next());
      const DisparityImage oracle = oracle_match(pair.left.view(), pair.right.view(), c.options);
      for (const MatcherOptions& options : implementations_of(c.options)) {
        EXPECT_TRUE(agrees(oracle, pair, {}, options, 1))
            << "  " << disparities << " disparities, window " << window;
      }
    }
  }
}

}  // namespace
}  // namespace stereod
