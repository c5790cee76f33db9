// SPDX-License-Identifier: BSD-3-Clause
// Defines the options of the matchers, their presets and their limits.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "core/base/cpu.h"
#include "core/base/enum_names.h"
#include "core/base/problem.h"
#include "core/match/disparity.h"

namespace stereod {

/// Selects the matcher: sums over windows (the thesis) or paths along rows. docs/matcher.md defines both.
enum class Method { kBlock, kSemiglobal };

/// Selects the samples of the semi-global matcher: every second row, with every second column or every column.
enum class Grid { kCoarse, kFine };

/// Selects the implementation (thesis, sections 3.3, 3.7 and 3.8; threads over bands apply to each). All give the same
/// result to the bit. The semi-global matcher has no sliding implementation.
enum class Implementation { kNaive, kSliding, kSimd };

/// Selects what is done to the images before they are compared.
enum class Prefilter {
  kNone,    ///< raw gray values, the thesis' cost
  kXsobel,  ///< horizontal Sobel gradient, clipped to ±cap: insensitive to exposure and slow shading
};

/// Selects the difference of two windows (thesis, equations 2.1 to 2.3). kSsd and kMad exist only in the naive
/// implementation, to compare the definitions.
enum class Cost { kSad, kSsd, kMad };

/// Holds the options of both matchers. Ranges and units are in matcher_option_table().
struct MatcherOptions {
  Method method = Method::kBlock;
  int min_disparity = 0;
  int disparities = 64;  ///< searched are [min_disparity, min_disparity + disparities)
  int window = 11;       ///< block: side of the support window [px]
  Cost cost = Cost::kSad;
  Prefilter prefilter = Prefilter::kXsobel;
  int prefilter_cap = 31;  ///< [gray levels]
  int texture_threshold =
      0;  ///< block: minimum sum of |gradient| (clipped to the cap) over the window; 0 is off
  int uniqueness_ratio =
      0;  ///< [%] a second match within this of the best cost, not beside it, rejects; 0 is off
  int left_right_max_diff = -1;  ///< [px] by which the right image's own match may differ; -1 is off
  bool subpixel = true;          ///< results in 1/16 px instead of whole pixels
  int median = 0;                ///< side of the median filter: 0 (off), 3, or 5 (block only) [px]
  int speckle_size = 0;          ///< regions of up to this many pixels are removed; 0 is off
  int speckle_max_diff = 1;      ///< [px] between neighbors of one region
  // The semi-global matcher's own:
  Grid grid = Grid::kCoarse;
  int p1 = 8;                 ///< cost of a step of one disparity along a path
  int p2 = 40;                ///< cost of a larger step, less the step in gray values there
  int census_weight = 4;      ///< cost of each of the eight comparisons that differ
  int gradient_limit = 20;    ///< maximum cost of differing gradients, and the cost outside the image
  bool hole_filling = false;  ///< pixels without a match get the value of a neighbor, see is_filled()
  Implementation implementation = Implementation::kSimd;
  Isa isa = Isa::kAuto;
  CacheUse cache = CacheUse::kAuto;

  friend bool operator==(const MatcherOptions&, const MatcherOptions&) = default;
  int units_per_pixel() const { return subpixel ? kSubpixelUnits : 1; }
};

/// Names of the presets. Block matching: `thesis` (raw sums of absolute differences, no filter), `fast` (a value for every
/// pixel). Semi-global: `robust` (unreliable pixels have no value), `dense` (as robust, but with uniqueness_ratio 0 and
/// hole_filling), `fine` (for thin objects).
inline constexpr std::array<std::string_view, 5> kMatcherPresets{"robust", "dense", "fine", "fast", "thesis"};

/// Returns the options of a preset, nothing if the name is unknown.
std::optional<MatcherOptions> matcher_preset(std::string_view name);

/// Returns the first option that has a value it cannot have, alone or with the others; nothing if the options can be
/// used.
std::optional<Problem> problem_with(const MatcherOptions& options);

inline constexpr EnumNames<Method, 2> kMethodNames{
    {{Method::kBlock, "block"}, {Method::kSemiglobal, "semiglobal"}}};
inline constexpr EnumNames<Grid, 2> kGridNames{{{Grid::kCoarse, "coarse"}, {Grid::kFine, "fine"}}};
inline constexpr EnumNames<Implementation, 3> kImplementationNames{{{Implementation::kNaive, "naive"},
                                                                    {Implementation::kSliding, "sliding"},
                                                                    {Implementation::kSimd, "simd"}}};
inline constexpr EnumNames<Prefilter, 2> kPrefilterNames{
    {{Prefilter::kNone, "none"}, {Prefilter::kXsobel, "xsobel"}}};
inline constexpr EnumNames<Cost, 3> kCostNames{
    {{Cost::kSad, "sad"}, {Cost::kSsd, "ssd"}, {Cost::kMad, "mad"}}};

/// Return the names used in configuration files, on command lines and in messages, and the values of such names; nothing
/// if the name is unknown.
std::string_view name_of(Method method);
std::string_view name_of(Grid grid);
std::string_view name_of(Implementation implementation);
std::string_view name_of(Prefilter prefilter);
std::string_view name_of(Cost cost);
std::optional<Method> parse_method(std::string_view name);
std::optional<Grid> parse_grid(std::string_view name);
std::optional<Implementation> parse_implementation(std::string_view name);
std::optional<Prefilter> parse_prefilter(std::string_view name);
std::optional<Cost> parse_cost(std::string_view name);

}  // namespace stereod
