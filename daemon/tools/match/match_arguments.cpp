// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/match/match_arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <thread>
#include <vector>

#include "core/match/option_table.h"
#include "daemon/config/sections.h"
#include "daemon/imagefile/disparity_file.h"

namespace stereod::tools {

namespace {

/// Holds the value of a flag that a table of options describes.
struct TableFlag {
  std::optional<std::string> text;
  bool yes = false, no = false;  ///< --KEY and --no-KEY of an option that is true or false
};

/// Holds the flags as they stand on the command line.
struct Flags {
  std::string left, right;
  std::optional<std::string> output, color, calibration, config, ground_truth;
  std::vector<std::string> rectified;
  std::optional<std::string> preset;
  std::vector<TableFlag> matcher = std::vector<TableFlag>(matcher_option_table().size());
  std::vector<TableFlag> rectify = std::vector<TableFlag>(rectify_options().size());
  std::optional<int> threads, repeat;
  std::optional<double> gt_scale;
};

/// Returns "--min-disparity" for the key min_disparity.
std::string flag_of(std::string_view key, const char* prefix = "--") {
  std::string flag = prefix + std::string(key);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

/// Returns the text about an option in --help.
std::string help_of(const OptionInfo& option) {
  std::string text(first_sentence(option));
  text.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
  if (option.type != OptionInfo::Type::kFlag) text += ": " + range_text(option);
  if (option.only_with.starts_with("method: "))
    text += ", only with --method " + std::string(option.only_with.substr(8));
  return text;
}

/// Declares a flag for each option of the table.
template <typename Settings>
void declare_table(CLI::App& app, const std::vector<Option<Settings>>& table, std::vector<TableFlag>& flags,
                   const char* group) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::string flag = flag_of(table[i].key);
    if (table[i].type == OptionInfo::Type::kFlag) {
      const std::string off = flag_of(table[i].key, "--no-");
      app.add_flag(flag, flags[i].yes, help_of(table[i]))->group(group);
      app.add_flag(off, flags[i].no, "the opposite of " + flag)->excludes(flag)->group(group);
    } else {
      app.add_option(flag, flags[i].text, help_of(table[i]))->group(group);
    }
  }
}

bool is_given(const TableFlag& flag) { return flag.text || flag.yes || flag.no; }

/// Sets what the flags say.
template <typename Settings>
void apply_table(const std::vector<Option<Settings>>& table, const std::vector<TableFlag>& flags,
                 Settings& settings) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!is_given(flags[i])) continue;
    const std::string text = flags[i].text.value_or(flags[i].yes ? "true" : "false");
    const std::optional<OptionValue> value = parse_value(table[i], text);
    if (!value) throw UsageError(flag_of(table[i].key) + ": " + complaint(table[i], text));
    table[i].set(settings, *value);
  }
}

void declare(CLI::App& app, Flags& flags) {
  app.add_option("LEFT", flags.left, "left image (reference): PNG, JPEG, PGM or PPM")->required();
  app.add_option("RIGHT", flags.right, "right image of the same size")->required();
  app.add_option("-o,--output", flags.output, "disparities: .pfm (Middlebury) or .png (16 bit, KITTI)");
  app.add_option("--color", flags.color, "an image for a person, with a scale: .png");
  app.add_option(
      "--preset", flags.preset,
      "settings of the matcher, instead of those in --config: " + range_text(matcher_preset_option()));
  app.add_option("--config", flags.config,
                 "take the settings of matcher and rectification from a stereod.yaml");
  app.add_option("--threads", flags.threads, "number of threads [1…256], default one for each CPU");
  app.add_option("--calibration", flags.calibration, "rectify both images first, by this calibration.yaml");
  app.add_option("--rectified", flags.rectified, "write the two images that were matched: .png .png")
      ->expected(2);
  app.add_option("--ground-truth", flags.ground_truth, "compare with the true disparities: image or .pfm");
  app.add_option("--gt-scale", flags.gt_scale, "gray levels per pixel of disparity in that image; default 1");
  app.add_option("--repeat", flags.repeat,
                 "additional measured runs; the median time is printed [1…1000000]");
  declare_table(app, matcher_option_table(), flags.matcher, "Matcher (defaults: those of the preset)");
  declare_table(app, rectify_options(), flags.rectify, "Rectification (with --calibration)");
}

/// Refuses flags of the method that is not selected.
void check_methods(const Flags& flags, Method method) {
  for (std::size_t i = 0; i < flags.matcher.size(); ++i) {
    const MatcherOption& option = matcher_option_table()[i];
    // --no-KEY asks for what the other method does anyway.
    if (!is_given(flags.matcher[i]) || flags.matcher[i].no || belongs_to(option, method)) continue;
    throw UsageError(flag_of(option.key) + ": belongs to --method " +
                     std::string(option.only_with.substr(option.only_with.find(' ') + 1)) +
                     ", but the method is " + std::string(name_of(method)));
  }
}

MatcherOptions matcher_options(const Flags& flags, const Config& config) {
  MatcherOptions options = config.matcher;
  if (flags.preset) {
    const std::optional<MatcherOptions> preset = matcher_preset(*flags.preset);
    if (!preset) throw UsageError("--preset: " + complaint(matcher_preset_option(), *flags.preset));
    options = *preset;
  }
  apply_table(matcher_option_table(), flags.matcher, options);
  check_methods(flags, options.method);
  if (const std::optional<Problem> problem = problem_with(options)) {
    const bool remedy = problem->key == "hole_filling";
    throw UsageError(flag_of(problem->key) + ": " + problem->message +
                     (remedy ? "; add " + flag_of(problem->key, "--no-") : ""));
  }
  return options;
}

RectifyConfig rectify_settings(const Flags& flags, const Config& config) {
  RectifyConfig rectify = config.rectify;
  for (std::size_t i = 0; i < flags.rectify.size(); ++i) {
    if (!is_given(flags.rectify[i]) || flags.calibration) continue;
    throw UsageError(flag_of(rectify_options()[i].key) + ": belongs to --calibration, which is missing");
  }
  apply_table(rectify_options(), flags.rectify, rectify);
  return rectify;
}

int in_range(int value, int minimum, int maximum, const char* flag) {
  if (value >= minimum && value <= maximum) return value;
  throw UsageError(std::string(flag) + ": found " + std::to_string(value) + ", allowed " +
                   std::to_string(minimum) + "…" + std::to_string(maximum));
}

std::filesystem::path png_name(const std::string& name) {
  std::filesystem::path path = name;
  if (path.extension() == ".png") return path;
  throw UsageError(name + ": must be named .png");
}

MatchArguments checked(const Flags& flags) {
  MatchArguments arguments;
  arguments.left = flags.left;
  arguments.right = flags.right;
  arguments.output = flags.output;
  arguments.calibration = flags.calibration;
  arguments.ground_truth = flags.ground_truth;
  if (flags.output) check_disparity_file_name(*flags.output);
  if (flags.color) arguments.color = png_name(*flags.color);
  if (flags.rectified.size() == 2) {
    arguments.rectified = RectifiedFiles{png_name(flags.rectified[0]), png_name(flags.rectified[1])};
  }
  if (!flags.output && !flags.color && !flags.ground_truth && !flags.repeat && !arguments.rectified) {
    throw UsageError("nothing to do; give -o, --color, --rectified, --ground-truth or --repeat");
  }
  if (flags.gt_scale && !flags.ground_truth) {
    throw UsageError("--gt-scale: belongs to --ground-truth, which is not there");
  }
  arguments.ground_truth_scale = flags.gt_scale.value_or(1);
  if (!(arguments.ground_truth_scale > 0 && std::isfinite(arguments.ground_truth_scale))) {
    throw UsageError("--gt-scale: must be above 0");
  }
  if (flags.repeat) arguments.repeat = in_range(*flags.repeat, 1, 1'000'000, "--repeat");
  const int cpus = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 256);
  arguments.threads = in_range(flags.threads.value_or(cpus), 1, 256, "--threads");
  Config config;
  if (flags.config) config = read_config(*flags.config);
  arguments.matcher = matcher_options(flags, config);
  arguments.rectify = rectify_settings(flags, config);
  return arguments;
}

}  // namespace

std::variant<MatchArguments, TextToPrint> parse_match_arguments(int argc, const char* const* argv) {
  CLI::App app("Runs the matcher of stereod on two image files.", "stereo-match");
  Flags flags;
  declare(app, flags);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return TextToPrint{app.help()};
  } catch (const CLI::ParseError& error) {
    std::string sentence = error.what();
    std::replace(sentence.begin(), sentence.end(), '\n', ' ');
    throw UsageError(sentence + "; see --help");
  }
  return checked(flags);
}

}  // namespace stereod::tools
