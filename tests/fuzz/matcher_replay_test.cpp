// SPDX-License-Identifier: BSD-3-Clause
// The check of the fuzz target on fixed inputs, for builds without libFuzzer.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/fuzz/matcher_input.h"
#include "tests/support/matcher_cases.h"

namespace stereod {
namespace {

std::vector<std::uint8_t> made_up_bytes(std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(random.between(0, 600)));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.between(0, 255));
  return bytes;
}

TEST(MatcherFuzzReplay, RandomBytes_AllAgree) {
  constexpr std::uint64_t kInputs = kSanitized ? 150 : 600;
  constexpr int kFailuresShown = 5;
  int used = 0;
  int failures = 0;
  for (std::uint64_t seed = 1; seed <= kInputs && failures < kFailuresShown; ++seed) {
    const std::optional<MatcherInput> input = matcher_input(made_up_bytes(seed));
    if (!input) continue;
    ++used;
    ASSERT_EQ(problem_with(input->options), std::nullopt) << "seed " << seed;
    const std::optional<std::string> disagreement = disagreement_on(*input);
    if (disagreement) {
      ++failures;
      ADD_FAILURE() << "seed " << seed << ": " << *disagreement;
    }
  }
  EXPECT_GT(used, static_cast<int>(kInputs) / 2) << "too many inputs are dropped as too slow";
}

TEST(MatcherFuzzReplay, Bytes_ReachEveryOption) {
  int prefilters = 0;
  int medians = 0;
  int speckles = 0;
  int wide = 0;
  int masks = 0;
  int surfaces = 0;
  int semiglobal = 0;
  int filled = 0;
  constexpr int kInputs = 300;
  for (std::uint64_t seed = 1; seed <= kInputs; ++seed) {
    const std::optional<MatcherInput> input = matcher_input(made_up_bytes(seed));
    if (!input) continue;
    prefilters += input->options.prefilter == Prefilter::kXsobel;
    medians += input->options.median > 0;
    speckles += input->options.speckle_size > 0;
    wide += input->options.window >= 17;
    masks += input->left_mask.has_value();
    semiglobal += input->options.method == Method::kSemiglobal;
    filled += input->options.hole_filling;
    surfaces += input->pair.left.width() >= input->options.window && input->options.min_disparity == 0;
  }
  for (const int count : {prefilters, medians, speckles, wide, masks, semiglobal, filled})
    EXPECT_GT(count, kInputs / 8);
  EXPECT_GT(surfaces, 3);
}

TEST(MatcherFuzzReplay, NoBytes_SmallestInput) {
  const std::optional<MatcherInput> input = matcher_input({});
  ASSERT_TRUE(input);
  EXPECT_EQ(input->pair.left.size(), (Size{1, 1}));
  EXPECT_EQ(disagreement_on(*input), std::nullopt);
}

}  // namespace
}  // namespace stereod
