// SPDX-License-Identifier: BSD-3-Clause
// The options of depth_quality.
#include "tests/bench/quality_arguments.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "core/base/problem.h"
#include "core/base/text.h"

namespace stereod::bench {
namespace {

constexpr std::array<std::pair<std::string_view, int MatcherOptions::*>, 8> kNumbers{{
    {"window", &MatcherOptions::window},
    {"prefilter_cap", &MatcherOptions::prefilter_cap},
    {"texture_threshold", &MatcherOptions::texture_threshold},
    {"uniqueness_ratio", &MatcherOptions::uniqueness_ratio},
    {"left_right_max_diff", &MatcherOptions::left_right_max_diff},
    {"median", &MatcherOptions::median},
    {"speckle_size", &MatcherOptions::speckle_size},
    {"speckle_max_diff", &MatcherOptions::speckle_max_diff},
}};

int to_number(const std::string& setting, const std::string& value) {
  std::size_t used = 0;
  try {
    const int number = std::stoi(value, &used);
    if (used == value.size()) return number;
  } catch (const std::logic_error&) {  // said below
  }
  throw std::runtime_error("--set " + setting + ": the value must be a whole number");
}

/// Applies a @p setting, key=value.
void apply(MatcherOptions& options, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) throw std::runtime_error("--set " + setting + ": must be key=value");
  const std::string key = setting.substr(0, equals);
  const std::string value = setting.substr(equals + 1);
  if (key == "prefilter") {
    const std::optional<Prefilter> prefilter = parse_prefilter(value);
    if (!prefilter) throw std::runtime_error("--set " + setting + ": allowed are none and xsobel");
    options.prefilter = *prefilter;
    return;
  }
  if (key == "subpixel") {
    options.subpixel = to_number(setting, value) != 0;
    return;
  }
  for (const auto& [name, member] : kNumbers) {
    if (name != key) continue;
    options.*member = to_number(setting, value);
    return;
  }
  std::string known = "prefilter, subpixel";
  for (const auto& number : kNumbers) known += ", " + std::string(number.first);
  throw std::runtime_error("--set " + setting + ": there is no such key; there are " + known);
}

MatcherOptions custom_preset(const std::string& base, const std::vector<std::string>& settings) {
  std::optional<MatcherOptions> options = matcher_preset(base);
  if (!options) {
    throw std::runtime_error("--base " + base + ": allowed are " + joined(kMatcherPresets));
  }
  for (const std::string& setting : settings) apply(*options, setting);
  if (const std::optional<Problem> problem = problem_with(*options))
    throw std::runtime_error(to_string(*problem));
  return *options;
}

}  // namespace

QualityArguments parse_quality_arguments(int argc, const char* const* argv) {
  QualityArguments arguments;
  std::string base = "robust";
  std::vector<std::string> settings;
  CLI::App app("depth_quality: judges the matcher and OpenCV's on images with ground truth", "depth_quality");
  app.add_option("--sets", arguments.sets, "only these sets: NAME,...")->delimiter(',');
  app.add_option("--matchers", arguments.matchers, "only these: BM (always there), SGBM, presets, custom")
      ->delimiter(',');
  app.add_option("--base", base, "the preset that --set changes: " + joined(kMatcherPresets));
  app.add_option("--set", settings, "one more preset, called custom: KEY=VALUE; may be given again")
      ->allow_extra_args(false);
  app.add_option("--images", arguments.image_directory, "write a PNG for each set into this directory");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    std::exit(EXIT_SUCCESS);
  } catch (const CLI::ParseError& error) {
    throw std::runtime_error(error.what());
  }
  if (!settings.empty()) arguments.custom = custom_preset(base, settings);
  return arguments;
}

}  // namespace stereod::bench
