// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/options.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace stereod {
namespace {

MatcherOptions changed(const std::function<void(MatcherOptions&)>& change) {
  MatcherOptions options;
  change(options);
  return options;
}

/// An option out of its range, and what the sentence about it must contain.
struct BadOption {
  std::string option;
  std::string found;
  std::vector<std::string> allowed;
  std::function<void(MatcherOptions&)> change;
};

std::ostream& operator<<(std::ostream& out, const BadOption& bad) {
  return out << bad.option << " = " << bad.found;
}

const std::vector<BadOption>& bad_options() {
  static const std::vector<BadOption> all = {
      {"min_disparity", "-1", {"0", "1024"}, [](auto& o) { o.min_disparity = -1; }},
      {"min_disparity", "1025", {"0", "1024"}, [](auto& o) { o.min_disparity = 1025; }},
      {"disparities", "0", {"1", "256"}, [](auto& o) { o.disparities = 0; }},
      {"disparities", "-5", {"1", "256"}, [](auto& o) { o.disparities = -5; }},
      {"disparities", "257", {"1", "256"}, [](auto& o) { o.disparities = 257; }},
      {"window", "1", {"3", "31"}, [](auto& o) { o.window = 1; }},
      {"window", "33", {"3", "31"}, [](auto& o) { o.window = 33; }},
      {"window", "10", {"odd", "3", "31"}, [](auto& o) { o.window = 10; }},
      {"prefilter_cap", "0", {"1", "63"}, [](auto& o) { o.prefilter_cap = 0; }},
      {"prefilter_cap", "64", {"1", "63"}, [](auto& o) { o.prefilter_cap = 64; }},
      {"texture_threshold", "-1", {"0"}, [](auto& o) { o.texture_threshold = -1; }},
      {"texture_threshold",
       "7",
       {"prefilter", "none", "xsobel"},
       [](auto& o) {
         o.texture_threshold = 7;
         o.prefilter = Prefilter::kNone;
       }},
      {"uniqueness_ratio", "-1", {"0", "100"}, [](auto& o) { o.uniqueness_ratio = -1; }},
      {"uniqueness_ratio", "101", {"0", "100"}, [](auto& o) { o.uniqueness_ratio = 101; }},
      {"left_right_max_diff", "-2", {"-1"}, [](auto& o) { o.left_right_max_diff = -2; }},
      {"median", "4", {"0", "3", "5"}, [](auto& o) { o.median = 4; }},
      {"median", "-3", {"0", "3", "5"}, [](auto& o) { o.median = -3; }},
      {"speckle_size", "-1", {"0"}, [](auto& o) { o.speckle_size = -1; }},
      {"speckle_max_diff", "-1", {"0"}, [](auto& o) { o.speckle_max_diff = -1; }},
      {"cost",
       "ssd",
       {"sliding", "naive"},
       [](auto& o) {
         o.cost = Cost::kSsd;
         o.implementation = Implementation::kSliding;
       }},
      {"p1", "-1", {"0", "255"}, [](auto& o) { o.p1 = -1; }},
      {"p2", "256", {"0", "255"}, [](auto& o) { o.p2 = 256; }},
      {"census_weight", "17", {"0", "16"}, [](auto& o) { o.census_weight = 17; }},
      {"gradient_limit", "65", {"0", "64"}, [](auto& o) { o.gradient_limit = 65; }},
      {"hole_filling", "true", {"semiglobal"}, [](auto& o) { o.hole_filling = true; }},
      {"cost",
       "ssd",
       {"semiglobal", "block"},
       [](auto& o) {
         o.method = Method::kSemiglobal;
         o.cost = Cost::kSsd;
         o.implementation = Implementation::kNaive;
       }},
      {"prefilter",
       "none",
       {"semiglobal", "xsobel"},
       [](auto& o) {
         o.method = Method::kSemiglobal;
         o.prefilter = Prefilter::kNone;
       }},
      {"texture_threshold",
       "7",
       {"semiglobal", "block"},
       [](auto& o) {
         o.method = Method::kSemiglobal;
         o.texture_threshold = 7;
       }},
      {"median",
       "5",
       {"semiglobal", "3"},
       [](auto& o) {
         o.method = Method::kSemiglobal;
         o.median = 5;
       }},
      {"implementation",
       "sliding",
       {"semiglobal", "naive", "simd"},
       [](auto& o) {
         o.method = Method::kSemiglobal;
         o.implementation = Implementation::kSliding;
       }},
      {"cost", "mad", {"simd", "naive"}, [](auto& o) { o.cost = Cost::kMad; }},
  };
  return all;
}

class ProblemWith : public testing::TestWithParam<BadOption> {};

TEST_P(ProblemWith, BadOption_NamesFoundAndAllowed) {
  const BadOption& bad = GetParam();
  const std::optional<std::string> problem = problem_with(changed(bad.change));
  ASSERT_TRUE(problem.has_value());
  const auto mentions = [&](const std::string& word) { return problem->find(word) != std::string::npos; };
  EXPECT_TRUE(mentions(bad.option)) << *problem;
  EXPECT_TRUE(mentions(bad.found)) << *problem;
  for (const std::string& word : bad.allowed)
    EXPECT_TRUE(mentions(word)) << "'" << word << "' in: " << *problem;
}

INSTANTIATE_TEST_SUITE_P(EveryOption, ProblemWith, testing::ValuesIn(bad_options()), [](const auto& test) {
  return test.param.option + "_" + std::to_string(test.index);
});

TEST(MatcherOptions, Defaults_HaveNoProblem) { EXPECT_EQ(problem_with(MatcherOptions{}), std::nullopt); }

TEST(MatcherOptions, RangeEnds_HaveNoProblem) {
  const std::vector<std::function<void(MatcherOptions&)>> changes = {
      [](auto& o) { o.min_disparity = 1024; },
      [](auto& o) { o.disparities = 1; },
      [](auto& o) { o.disparities = 256; },
      [](auto& o) { o.window = 3; },
      [](auto& o) { o.window = 31; },
      [](auto& o) { o.prefilter_cap = 1; },
      [](auto& o) { o.prefilter_cap = 63; },
      [](auto& o) { o.prefilter = Prefilter::kNone; },
      [](auto& o) { o.texture_threshold = 1; },
      [](auto& o) { o.texture_threshold = 63 * 31 * 31; },
      [](auto& o) { o.uniqueness_ratio = 100; },
      [](auto& o) { o.left_right_max_diff = 0; },
      [](auto& o) { o.left_right_max_diff = -1; },
      [](auto& o) { o.median = 3; },
      [](auto& o) { o.median = 5; },
      [](auto& o) { o.speckle_size = 1; },
      [](auto& o) { o.speckle_max_diff = 0; },
      [](auto& o) { o.p1 = 0; },
      [](auto& o) { o.p2 = 255; },
      [](auto& o) { o.census_weight = 16; },
      [](auto& o) { o.gradient_limit = 64; },
      [](auto& o) {
        o.cost = Cost::kMad;
        o.implementation = Implementation::kNaive;
      },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(problem_with(changed(changes[i])), std::nullopt) << "change " << i;
  }
}

template <typename Enum, typename Parse>
void expect_names_come_back(const std::vector<Enum>& values, Parse&& parse) {
  std::set<std::string> names;
  for (const Enum value : values) {
    const std::string name(name_of(value));
    EXPECT_TRUE(names.insert(name).second) << name << " names two values";
    EXPECT_EQ(parse(name), value) << name;
    EXPECT_EQ(parse(name + " "), std::nullopt);
  }
  EXPECT_EQ(parse(""), std::nullopt);
  EXPECT_EQ(parse("magic"), std::nullopt);
}

TEST(MatcherOptions, Names_ParseToTheirValues) {
  expect_names_come_back<Method>({Method::kBlock, Method::kSemiglobal}, parse_method);
  expect_names_come_back<Grid>({Grid::kCoarse, Grid::kFine}, parse_grid);
  using enum Implementation;
  using enum Isa;
  using enum Prefilter;
  using enum Cost;
  expect_names_come_back<Implementation>({kNaive, kSliding, kSimd}, parse_implementation);
  expect_names_come_back<Isa>({kAuto, kScalar, kSsse3, kSse41, kAvx2, kNeon}, parse_isa);
  expect_names_come_back<Prefilter>({kNone, kXsobel}, parse_prefilter);
  expect_names_come_back<Cost>({kSad, kSsd, kMad}, parse_cost);
}

TEST(MatcherOptions, EveryPreset_HasNoProblem) {
  std::string list(kMatcherPresets);
  int presets = 0;
  for (std::size_t begin = 0; begin < list.size(); ++presets) {
    const std::size_t comma = list.find(", ", begin);
    const std::string name = list.substr(begin, comma - begin);
    begin = comma == std::string::npos ? list.size() : comma + 2;
    const std::optional<MatcherOptions> options = matcher_preset(name);
    ASSERT_TRUE(options.has_value()) << name;
    EXPECT_EQ(problem_with(*options), std::nullopt) << name;
  }
  EXPECT_EQ(presets, 5);
  EXPECT_EQ(matcher_preset("best"), std::nullopt);
  EXPECT_EQ(matcher_preset(""), std::nullopt);
}

TEST(MatcherOptions, Presets_OnlyDenseFills) {
  for (const char* name : {"thesis", "fast", "robust", "fine"}) {
    EXPECT_FALSE(matcher_preset(name)->hole_filling) << name;
  }
  MatcherOptions dense = matcher_preset("dense").value();
  EXPECT_TRUE(dense.hole_filling);
  dense.hole_filling = false;
  dense.uniqueness_ratio = matcher_preset("robust")->uniqueness_ratio;
  EXPECT_EQ(dense, matcher_preset("robust"));
}

TEST(MatcherOptions, ThesisPreset_IsThesisMatcher) {
  const MatcherOptions thesis = matcher_preset("thesis").value();
  EXPECT_EQ(thesis.window, 11);
  EXPECT_EQ(thesis.disparities, 64);
  EXPECT_EQ(thesis.cost, Cost::kSad);
  EXPECT_EQ(thesis.prefilter, Prefilter::kNone);
  EXPECT_FALSE(thesis.subpixel);
  EXPECT_EQ(thesis.texture_threshold, 0);
  EXPECT_EQ(thesis.uniqueness_ratio, 0);
  EXPECT_EQ(thesis.left_right_max_diff, -1);
  EXPECT_EQ(thesis.median, 0);
  EXPECT_EQ(thesis.speckle_size, 0);
}

TEST(MatcherOptions, Units_FollowSubpixel) {
  EXPECT_EQ(changed([](auto& o) { o.subpixel = true; }).units_per_pixel(), 16);
  EXPECT_EQ(changed([](auto& o) { o.subpixel = false; }).units_per_pixel(), 1);
}

}  // namespace
}  // namespace stereod
