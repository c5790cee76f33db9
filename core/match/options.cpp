// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/options.h"

#include <string>

#include "core/match/option_table.h"

namespace stereod {

std::string_view name_of(Method method) { return find_name(kMethodNames, method); }
std::string_view name_of(Grid grid) { return find_name(kGridNames, grid); }
std::string_view name_of(Implementation implementation) {
  return find_name(kImplementationNames, implementation);
}
std::string_view name_of(Prefilter prefilter) { return find_name(kPrefilterNames, prefilter); }
std::string_view name_of(Cost cost) { return find_name(kCostNames, cost); }

std::optional<Method> parse_method(std::string_view name) { return find_value(kMethodNames, name); }
std::optional<Grid> parse_grid(std::string_view name) { return find_value(kGridNames, name); }
std::optional<Implementation> parse_implementation(std::string_view name) {
  return find_value(kImplementationNames, name);
}
std::optional<Prefilter> parse_prefilter(std::string_view name) { return find_value(kPrefilterNames, name); }
std::optional<Cost> parse_cost(std::string_view name) { return find_value(kCostNames, name); }

std::optional<MatcherOptions> matcher_preset(std::string_view name) {
  MatcherOptions options;
  if (name == "thesis") {
    options.prefilter = Prefilter::kNone;
    options.subpixel = false;
    return options;
  }
  // Chosen on the Middlebury sets, see docs/measurements.md: a cap of 20 is as good as OpenCV's 31.
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
  // Rejects 2 % of the pixels and removes a fifth of the errors.
  options.uniqueness_ratio = 15;
  if (name == "robust") return options;
  if (name == "fine") {
    options.grid = Grid::kFine;
    return options;
  }
  return std::nullopt;
}

namespace {

std::string with(std::string_view found, std::string_view key, std::string_view value) {
  return "found " + std::string(found) + " with " + std::string(key) + " " + std::string(value);
}

/// Finds an option that the other matcher has and this one lacks.
std::optional<Problem> problem_with_method(const MatcherOptions& o) {
  const auto found = [&](std::string_view value) { return with(value, "method", name_of(o.method)); };
  if (o.method == Method::kBlock) {
    if (!o.hole_filling) return std::nullopt;
    return Problem{"hole_filling", found("true") + ", allowed false (only method semiglobal fills holes)"};
  }
  if (o.cost != Cost::kSad) {
    return Problem{"cost",
                   found(name_of(o.cost)) + ", allowed sad (the others exist only with method block)"};
  }
  if (o.prefilter == Prefilter::kNone) {
    return Problem{"prefilter", found("none") + ", allowed xsobel (the method compares gradients)"};
  }
  if (o.texture_threshold > 0) {
    return Problem{"texture_threshold", found(std::to_string(o.texture_threshold)) +
                                            ", allowed 0 (the test exists only with method block)"};
  }
  if (o.median == 5) return Problem{"median", found("5") + ", allowed 0, 3"};
  if (o.implementation == Implementation::kSliding) {
    return Problem{"implementation", found("sliding") + ", allowed naive, simd"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Problem> problem_with(const MatcherOptions& o) {
  for (const MatcherOption& option : matcher_option_table()) {
    const OptionValue value = option.get(o);
    if (!allows(option, value)) {
      return Problem{std::string(option.key), complaint(option, value_text(option, value))};
    }
  }
  if (auto problem = problem_with_method(o)) return problem;
  if (o.texture_threshold > 0 && o.prefilter == Prefilter::kNone) {
    return Problem{"texture_threshold", with(std::to_string(o.texture_threshold), "prefilter", "none") +
                                            ", allowed 0 (texture is measured on the xsobel image)"};
  }
  if (o.cost != Cost::kSad && o.implementation != Implementation::kNaive) {
    return Problem{"cost", with(name_of(o.cost), "implementation", name_of(o.implementation)) +
                               ", allowed sad (the others exist only with implementation naive)"};
  }
  return std::nullopt;
}

}  // namespace stereod
