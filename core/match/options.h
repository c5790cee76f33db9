// What can be asked of the matchers, and what cannot.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/cpu.h"
#include "core/match/disparity.h"

namespace stereod {

/// Which matcher: the thesis' sums over windows, or paths along rows. docs/matcher.md defines both.
enum class Method { kBlock, kSemiglobal };

/// The points at which the semi-global matcher looks: every second row, and every second column or each.
enum class Grid { kCoarse, kFine };

/// Four stages of the same matcher (thesis, sections 3.3, 3.7 and 3.8; the fourth, threads over bands,
/// applies to each). All give the same result to the bit. The semi-global matcher has no sliding one.
enum class Implementation { kNaive, kSliding, kSimd };

/// What the images go through before they are compared.
enum class Prefilter {
  kNone,    ///< raw gray values, the thesis' cost
  kXsobel,  ///< horizontal Sobel gradient, clipped to ±cap: insensitive to exposure and slow shading
};

/// How a window's difference is measured (thesis, equations 2.1 to 2.3). All but kSad exist only in the naive
/// implementation, so that the definitions can be compared.
enum class Cost { kSad, kSsd, kMad };

struct MatcherOptions {
  Method method = Method::kBlock;
  int min_disparity = 0;  ///< 0…1024 px
  int disparities = 64;   ///< 1…256; searched are [min_disparity, min_disparity + disparities)
  int window = 11;        ///< block: side of the square support window, odd, 3…31 px
  Cost cost = Cost::kSad;
  Prefilter prefilter = Prefilter::kXsobel;
  int prefilter_cap = 31;  ///< 1…63 gray levels
  int texture_threshold =
      0;  ///< block: least sum over the window of |gradient| (clipped to the cap); 0 is off
  int uniqueness_ratio = 0;  ///< %; a rival within this of the best cost, not beside it, rejects; 0 is off
  int left_right_max_diff = -1;  ///< px the right image's own choice may differ; -1 is off
  bool subpixel = true;          ///< answers in 1/16 px instead of whole pixels
  int median = 0;                ///< side of the median: 0 (off), 3 or (block only) 5
  int speckle_size = 0;          ///< regions of up to this many pixels are removed; 0 is off
  int speckle_max_diff = 1;      ///< px between neighbors of one region
  // The semi-global matcher's own:
  Grid grid = Grid::kCoarse;
  int p1 = 8;                 ///< what a step of one disparity costs along a path, 0…255
  int p2 = 40;                ///< what a larger step costs, less the step in gray values there, 0…255
  int census_weight = 4;      ///< cost of each of the eight comparisons that differ, 0…16
  int gradient_limit = 20;    ///< most that differing gradients cost, and what lies outside the image, 0…64
  bool hole_filling = false;  ///< pixels without a match get that of a neighbor, see is_filled()
  Implementation implementation = Implementation::kSimd;
  Isa isa = Isa::kAuto;
  CacheUse cache = CacheUse::kAuto;

  friend bool operator==(const MatcherOptions&, const MatcherOptions&) = default;
  int units_per_pixel() const { return subpixel ? kSubpixelUnits : 1; }
};

/// Named settings: block matching `thesis` (raw sums of absolute differences, no filter) and `fast` (an
/// answer for every pixel); semi-global `robust` (no ghosts), `dense` (the same, filled) and `fine` (for thin
/// things). Nothing if there is no such preset.
std::optional<MatcherOptions> matcher_preset(std::string_view name);
inline constexpr std::string_view kMatcherPresets = "thesis, fast, robust, dense, fine";

/// What is wrong with the options, as a sentence that names the option, what was found and what is allowed;
/// nothing if they are fine.
std::optional<std::string> problem_with(const MatcherOptions& options);

/// The names used in configuration files, on command lines and in messages. parse_…: nothing if unknown.
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
