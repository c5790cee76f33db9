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
               "Matching along paths (semiglobal) or by square windows (block). A key that exists only with the "
               "other method is an error."}),
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
               "Pixels that are matched; the others are interpolated. coarse: every second row and every second "
               "column. fine: every second row and every column (for thin objects)."}),
      option<&M::p1>({.key = "p1",
                      .minimum = 0,
                      .maximum = 255,
                      .only_with = kOnlySemiglobal,
                      .description = "Cost of a disparity step of 1 along a path."}),
      option<&M::p2>(
          {.key = "p2",
           .minimum = 0,
           .maximum = 255,
           .only_with = kOnlySemiglobal,
           .description =
               "Cost of a disparity step larger than 1, minus the difference of the gray levels at that place."}),
      option<&M::census_weight>(
          {.key = "census_weight",
           .minimum = 0,
           .maximum = 16,
           .only_with = kOnlySemiglobal,
           .description = "Cost of one differing census comparison (there are eight per pixel)."}),
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
           .description =
               "The cost of every other match (except the two neighboring disparities) must exceed the lowest cost "
               "by this percentage. 0 turns the test off."}),
      option<&M::left_right_max_diff>(
          {.key = "left_right_max_diff",
           .unit = "px",
           .minimum = -1,
           .maximum = 255,
           .description =
               "Maximum difference between the disparity of the left pixel and the disparity found from the right "
               "image. -1 turns the test off."}),
      option<&M::subpixel>(
          {.key = "subpixel", .description = "Resolution of disparities: 1/16 px (true) or 1 px (false)."}),
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
               "Maximum area of the isolated regions that are removed. The filter needs the whole frame, so rows "
               "are sent only after the last row is matched."}),
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
               "Memory layout of a worker, for the cache of the CPU. It does not change the results. Each worker "
               "takes 0.7 MB (large) or 0.45 MB (small, for a first-level cache of 24 KiB); auto selects by the "
               "CPU."}),
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
          "A set of matcher settings; each other key replaces one of them. robust: for robots; unreliable "
          "pixels have no value. dense: as robust, but with uniqueness_ratio: 0 and hole_filling: true; "
          "messages mark the filled pixels. fine: as robust, at twice the work, for thin objects. fast: block "
          "matching with a value for every pixel. thesis: block matching by sums of absolute differences of "
          "gray levels, without any test."};
  return option;
}

bool belongs_to(const MatcherOption& option, Method method) {
  return option.only_with.empty() || option.only_with == "method: " + std::string(name_of(method));
}

}  // namespace stereod
