#include "core/match/options.h"

#include "core/base/enum_names.h"

namespace stereod {
namespace {

constexpr EnumNames<Method, 2> kMethods{{{Method::kBlock, "block"}, {Method::kSemiglobal, "semiglobal"}}};
constexpr EnumNames<Grid, 2> kGrids{{{Grid::kCoarse, "coarse"}, {Grid::kFine, "fine"}}};
constexpr EnumNames<Implementation, 3> kImplementations{{{Implementation::kNaive, "naive"},
                                                         {Implementation::kSliding, "sliding"},
                                                         {Implementation::kSimd, "simd"}}};
constexpr EnumNames<Prefilter, 2> kPrefilters{{{Prefilter::kNone, "none"}, {Prefilter::kXsobel, "xsobel"}}};
constexpr EnumNames<Cost, 3> kCosts{{{Cost::kSad, "sad"}, {Cost::kSsd, "ssd"}, {Cost::kMad, "mad"}}};

std::optional<std::string> outside(std::string_view option, int value, int least, int most) {
  if (value >= least && value <= most) return std::nullopt;
  return std::string(option) + " is " + std::to_string(value) + ", allowed are " + std::to_string(least) +
         " to " + std::to_string(most);
}

}  // namespace

std::string_view name_of(Method method) { return find_name(kMethods, method); }
std::string_view name_of(Grid grid) { return find_name(kGrids, grid); }
std::string_view name_of(Implementation implementation) {
  return find_name(kImplementations, implementation);
}
std::string_view name_of(Prefilter prefilter) { return find_name(kPrefilters, prefilter); }
std::string_view name_of(Cost cost) { return find_name(kCosts, cost); }

std::optional<Method> parse_method(std::string_view name) { return find_value(kMethods, name); }
std::optional<Grid> parse_grid(std::string_view name) { return find_value(kGrids, name); }
std::optional<Implementation> parse_implementation(std::string_view name) {
  return find_value(kImplementations, name);
}
std::optional<Prefilter> parse_prefilter(std::string_view name) { return find_value(kPrefilters, name); }
std::optional<Cost> parse_cost(std::string_view name) { return find_value(kCosts, name); }

std::optional<MatcherOptions> matcher_preset(std::string_view name) {
  MatcherOptions options;
  if (name == "thesis") {
    options.prefilter = Prefilter::kNone;
    options.subpixel = false;
    return options;
  }
  // Chosen on the Middlebury sets, see docs/measurements.md; a cap of 20 instead of OpenCV's 31 costs
  // nothing.
  if (name == "fast") {
    options.prefilter_cap = 20;
    return options;
  }
  options.method = Method::kSemiglobal;
  options.left_right_max_diff = 1;
  options.median = 3;
  if (name == "dense") {
    options.hole_filling = true;
    return options;
  }
  // Two pixels in a hundred for a fifth of the errors.
  options.uniqueness_ratio = 15;
  if (name == "robust") return options;
  if (name == "fine") {
    options.grid = Grid::kFine;
    return options;
  }
  return std::nullopt;
}

namespace {

// What block matching alone can do, and what semi-global matching alone can.
std::optional<std::string> problem_with_method(const MatcherOptions& o) {
  const auto only = [&](std::string_view option, const std::string& value, const std::string& remedy) {
    return std::string(option) + " is " + value + " but method is " + std::string(name_of(o.method)) + "; " +
           remedy;
  };
  if (o.method == Method::kBlock) {
    if (o.hole_filling)
      return only("hole_filling", "true",
                  "only method: semiglobal fills, so do without it (fill: false, or --no-hole-filling)");
    return std::nullopt;
  }
  if (o.cost != Cost::kSad) {
    return only("cost", std::string(name_of(o.cost)), "costs other than sad exist only in method: block");
  }
  if (o.prefilter == Prefilter::kNone) {
    return only("prefilter", "none", "it compares gradients, so leave prefilter: xsobel");
  }
  if (o.texture_threshold > 0) {
    return only("texture_threshold", std::to_string(o.texture_threshold),
                "that test exists only in method: block, so set texture_threshold: 0");
  }
  if (o.median == 5) return only("median", "5", "it has a median of 3 or none (0)");
  if (o.implementation == Implementation::kSliding) {
    return only("implementation", "sliding", "that exists only in method: block; naive and simd are allowed");
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> problem_with(const MatcherOptions& o) {
  for (const auto& problem : {
           outside("min_disparity", o.min_disparity, 0, 1024),
           outside("disparities", o.disparities, 1, 256),
           outside("window", o.window, 3, 31),
           outside("prefilter_cap", o.prefilter_cap, 1, 63),
           outside("texture_threshold", o.texture_threshold, 0, 100'000),
           outside("uniqueness_ratio", o.uniqueness_ratio, 0, 100),
           outside("left_right_max_diff", o.left_right_max_diff, -1, 255),
           outside("speckle_size", o.speckle_size, 0, 1'000'000),
           outside("speckle_max_diff", o.speckle_max_diff, 0, 255),
           outside("p1", o.p1, 0, 255),
           outside("p2", o.p2, 0, 255),
           outside("census_weight", o.census_weight, 0, 16),
           outside("gradient_limit", o.gradient_limit, 0, 64),
       }) {
    if (problem) return problem;
  }
  if (o.window % 2 == 0)
    return "window is " + std::to_string(o.window) + ", allowed are odd numbers from 3 to 31";
  if (o.median != 0 && o.median != 3 && o.median != 5) {
    return "median is " + std::to_string(o.median) + ", allowed are 0 (off), 3 and 5";
  }
  if (const auto problem = problem_with_method(o)) return problem;
  if (o.texture_threshold > 0 && o.prefilter == Prefilter::kNone) {
    return "texture_threshold is " + std::to_string(o.texture_threshold) +
           " but prefilter is none; the texture is measured on the xsobel image, so set prefilter: xsobel "
           "or "
           "texture_threshold: 0";
  }
  if (o.cost != Cost::kSad && o.implementation != Implementation::kNaive) {
    return "cost is " + std::string(name_of(o.cost)) + " but implementation is " +
           std::string(name_of(o.implementation)) +
           "; costs other than sad exist only in implementation: naive";
  }
  return std::nullopt;
}

}  // namespace stereod
