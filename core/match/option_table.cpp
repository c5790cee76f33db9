// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/option_table.h"

#include <string>

namespace stereod {
namespace {

constexpr std::string_view kOnlyBlock = "method: block", kOnlySemiglobal = "method: semiglobal";

std::vector<MatcherOption> make_table() {
  using M = MatcherOptions;
  return {
      choice<kMethodNames, &M::method>(
          {.key = "method",
           .description =
               "Matching along paths (semiglobal) or by square windows (block). A key of the method that is "
               "not selected is refused."}),
      option<&M::min_disparity>({.key = "min_disparity",
                                 .unit = "px",
                                 .minimum = 0,
                                 .maximum = 1024,
                                 .description = "First disparity of the search."}),
      option<&M::disparities>(
          {.key = "disparities",
           .unit = "px",
           .minimum = 1,
           .maximum = 256,
           .description =
               "Number of disparities searched. The minimum distance measured is focal length × baseline / "
               "(min_disparity + disparities)."}),
      choice<kGridNames, &M::grid>(
          {.key = "grid",
           .only_with = kOnlySemiglobal,
           .description =
               "Samples compared. coarse takes every second row and column, fine every second row and each "
               "column, for thin objects."}),
      option<&M::p1>({.key = "p1",
                      .minimum = 0,
                      .maximum = 255,
                      .only_with = kOnlySemiglobal,
                      .description = "Cost of a disparity step of 1 along a path."}),
      option<&M::p2>({.key = "p2",
                      .minimum = 0,
                      .maximum = 255,
                      .only_with = kOnlySemiglobal,
                      .description = "Cost of a larger disparity step, less the step in gray levels there."}),
      option<&M::census_weight>({.key = "census_weight",
                                 .minimum = 0,
                                 .maximum = 16,
                                 .only_with = kOnlySemiglobal,
                                 .description = "Cost of each of the eight census comparisons that differ."}),
      option<&M::gradient_limit>({.key = "gradient_limit",
                                  .minimum = 0,
                                  .maximum = 64,
                                  .only_with = kOnlySemiglobal,
                                  .description = "Maximum cost of differing gradients."}),
      option<&M::hole_filling>(
          {.key = "hole_filling",
           .only_with = kOnlySemiglobal,
           .description =
               "Gives pixels without a match the lower disparity of their neighbors. Messages mark these "
               "pixels; image files do not."}),
      option<&M::window>({.key = "window",
                          .unit = "px",
                          .minimum = 3,
                          .maximum = 31,
                          .odd = true,
                          .only_with = kOnlyBlock,
                          .description = "Side of the square window that is compared."}),
      choice<kPrefilterNames, &M::prefilter>(
          {.key = "prefilter",
           .description =
               "Values compared: gray levels (none) or horizontal gradients (xsobel). Gradients make the match "
               "independent of exposure; method semiglobal needs them."}),
      option<&M::prefilter_cap>({.key = "prefilter_cap",
                                 .unit = "gray levels",
                                 .minimum = 1,
                                 .maximum = 63,
                                 .description = "Limit to which gradients are clipped."}),
      option<&M::texture_threshold>(
          {.key = "texture_threshold",
           .minimum = 0,
           .maximum = 100'000,
           .default_name = "off",
           .only_with = kOnlyBlock,
           .description = "Minimum sum of the gradients in a window. Needs prefilter: xsobel."}),
      option<&M::uniqueness_ratio>(
          {.key = "uniqueness_ratio",
           .unit = "%",
           .minimum = 0,
           .maximum = 100,
           .description = "Margin by which the best match must beat the others. 0 turns the test off."}),
      option<&M::left_right_max_diff>(
          {.key = "left_right_max_diff",
           .unit = "px",
           .minimum = -1,
           .maximum = 255,
           .description =
               "Maximum difference to the match found from the right image. -1 turns the test off."}),
      option<&M::subpixel>(
          {.key = "subpixel", .description = "Measures in 1/16 px (true) or whole pixels (false)."}),
      option<&M::median>(
          {.key = "median",
           .unit = "px",
           .only = {0, 3, 5},
           .description = "Side of the median filter. 0 turns it off; 5 exists only with method block."}),
      option<&M::speckle_size>(
          {.key = "speckle_size",
           .unit = "px",
           .minimum = 0,
           .maximum = 1'000'000,
           .default_name = "off",
           .description =
               "Maximum area of the isolated regions that are removed. The filter waits for the whole frame; "
               "without it rows leave as soon as they are matched."}),
      option<&M::speckle_max_diff>(
          {.key = "speckle_max_diff",
           .unit = "px",
           .minimum = 0,
           .maximum = 255,
           .description = "Maximum difference of neighbors in one region of the speckle filter."}),
      choice<kImplementationNames, &M::implementation>(
          {.key = "implementation",
           .description =
               "Implementation of the matcher; the results are equal. Only simd is fast; sliding exists only "
               "with method block, and the daemon refuses naive with method semiglobal."}),
      choice<kIsaNames, &M::isa>(
          {.key = "isa",
           .description = "Instruction set of the implementation simd. auto takes the best of this CPU."}),
      choice<kCacheUseNames, &M::cache>(
          {.key = "cache",
           .only_with = kOnlyBlock,
           .description =
               "Use of the CPU's caches; the results are equal. Each worker takes 0.7 MB (large) or 0.45 MB "
               "(small, for a first-level cache of 24 KiB); auto selects by the CPU."}),
      choice<kCostNames, &M::cost>(
          {.key = "cost",
           .only_with = kOnlyBlock,
           .description =
               "Difference of two windows: sums of absolute or squared differences, or the maximum. ssd and mad "
               "exist only in implementation: naive."}),
  };
}

}  // namespace

const std::vector<MatcherOption>& matcher_option_table() {
  static const std::vector<MatcherOption> table = make_table();
  return table;
}

const OptionInfo& matcher_preset_option() {
  static const OptionInfo option{
      .key = "preset",
      .type = OptionInfo::Type::kChoice,
      .names = {kMatcherPresets.begin(), kMatcherPresets.end()},
      .description =
          "Settings of the matcher; the other keys change single ones. robust: for robots; pixels that cannot be trusted have no value. dense: robust with filled holes, which messages mark. fine: robust at twice the work, for thin objects. fast: block matching with a value for every pixel. thesis: block matching by sums of absolute differences of gray levels, without any test."};
  return option;
}

bool belongs_to(const MatcherOption& option, Method method) {
  return option.only_with.empty() || option.only_with == "method: " + std::string(name_of(method));
}

}  // namespace stereod
