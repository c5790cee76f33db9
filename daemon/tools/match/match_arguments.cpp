// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/match/match_arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <string_view>
#include <thread>
#include <vector>

#include "daemon/imagefile/disparity_file.h"

namespace stereod::tools {

namespace {

/// The flags as they stand on the command line.
struct Flags {
  std::string left, right;
  std::optional<std::string> output, color, calibration, config, ground_truth;
  std::vector<std::string> rectified;
  std::optional<std::string> preset, method, grid, implementation, isa, cost;
  std::optional<int> disparities, min_disparity, window, p1, p2, census_weight, gradient_limit, threads,
      repeat;
  std::optional<std::string> interpolation;
  std::optional<double> gt_scale, alpha;
  bool fill = false, no_fill = false;
};

void declare(CLI::App& app, Flags& flags) {
  app.add_option("LEFT", flags.left, "left image (reference): PNG, JPEG, PGM or PPM")->required();
  app.add_option("RIGHT", flags.right, "right image of the same size")->required();
  app.add_option("-o,--output", flags.output, "disparities: .pfm (px, Middlebury) or .png (16 bit, KITTI)");
  app.add_option("--color", flags.color, "disparities in colors with a scale bar: .png");
  app.add_option("--preset", flags.preset,
                 "matcher settings, also instead of all those in --config: " + std::string(kMatcherPresets));
  app.add_option("--config", flags.config, "stereod.yaml with settings of matcher and rectification");
  app.add_option("--disparities", flags.disparities, "how many disparities are searched, 1 to 256");
  app.add_option("--min-disparity", flags.min_disparity, "the first of them, in pixels");
  app.add_option("--method", flags.method, "the matcher: block or semiglobal; default: the preset's");
  app.add_option("--window", flags.window, "block: side of the support window, odd, 3 to 31 pixels");
  app.add_option("--grid", flags.grid, "semiglobal: coarse, or fine for thin things");
  app.add_option("--p1", flags.p1, "semiglobal: what a step of one disparity costs, 0 to 255");
  app.add_option("--p2", flags.p2, "semiglobal: what a larger step costs at most, 0 to 255");
  app.add_option("--census-weight", flags.census_weight,
                 "semiglobal: what each census bit that differs costs, 0 to 16");
  app.add_option("--gradient-limit", flags.gradient_limit,
                 "semiglobal: what differing gradients cost at most, 0 to 64");
  app.add_flag("--hole-filling", flags.fill,
               "semiglobal: pixels without a match get that of a neighbor, in images and files too");
  app.add_flag("--no-hole-filling", flags.no_fill, "semiglobal: they do not, whatever the preset says")
      ->excludes("--hole-filling");
  app.add_option("--cost", flags.cost, "sad, ssd or mad (the last two: only --implementation naive)");
  app.add_option("--implementation", flags.implementation, "naive, sliding or simd");
  app.add_option("--isa", flags.isa, "instruction set for simd: auto, scalar, ssse3, sse41, avx2 or neon");
  app.add_option("--threads", flags.threads, "[1…256] default: one per CPU");
  app.add_option("--calibration", flags.calibration, "calibration.yaml; rectifies both images first");
  app.add_option("--interpolation", flags.interpolation, "with --calibration: bilinear (default) or nearest");
  app.add_option("--alpha", flags.alpha,
                 "with --calibration: from 0, only what both cameras have pixels for, to 1, all of it");
  app.add_option("--rectified", flags.rectified, "write the two matched images: .png .png")->expected(2);
  app.add_option("--ground-truth", flags.ground_truth, "true disparities to compare with: image or .pfm");
  app.add_option("--gt-scale", flags.gt_scale,
                 "[> 0] gray levels per px of disparity in the ground truth image; default 1");
  app.add_option("--repeat", flags.repeat, "[1…1000000] match N more times and print the median time");
}

template <typename Value>
Value named(const std::optional<Value>& value, const std::string& name, const char* flag,
            const std::string& allowed) {
  if (value) return *value;
  throw UsageError(std::string(flag) + ": '" + name + "' is not known; allowed are " + allowed);
}

void apply_method(const Flags& flags, MatcherOptions& options) {
  if (flags.method) {
    options.method = named(parse_method(*flags.method), *flags.method, "--method", "block, semiglobal");
  }
  const auto refuse = [&](bool given, const char* flag, Method owner) {
    if (given && options.method != owner) {
      throw UsageError(std::string(flag) + ": belongs to --method " + std::string(name_of(owner)) +
                       "; the one chosen is " + std::string(name_of(options.method)));
    }
  };
  refuse(flags.window.has_value(), "--window", Method::kBlock);
  refuse(flags.grid.has_value(), "--grid", Method::kSemiglobal);
  refuse(flags.p1.has_value(), "--p1", Method::kSemiglobal);
  refuse(flags.p2.has_value(), "--p2", Method::kSemiglobal);
  refuse(flags.census_weight.has_value(), "--census-weight", Method::kSemiglobal);
  refuse(flags.gradient_limit.has_value(), "--gradient-limit", Method::kSemiglobal);
  refuse(flags.fill, "--hole-filling", Method::kSemiglobal);
  options.window = flags.window.value_or(options.window);
  if (flags.grid) options.grid = named(parse_grid(*flags.grid), *flags.grid, "--grid", "coarse, fine");
  options.p1 = flags.p1.value_or(options.p1);
  options.p2 = flags.p2.value_or(options.p2);
  options.census_weight = flags.census_weight.value_or(options.census_weight);
  options.gradient_limit = flags.gradient_limit.value_or(options.gradient_limit);
  options.hole_filling = (options.hole_filling || flags.fill) && !flags.no_fill;
}

MatcherOptions matcher_options(const Flags& flags, const Config& config) {
  MatcherOptions options = config.matcher;
  if (flags.preset) {
    options = named(matcher_preset(*flags.preset), *flags.preset, "--preset", std::string(kMatcherPresets));
  }
  options.disparities = flags.disparities.value_or(options.disparities);
  options.min_disparity = flags.min_disparity.value_or(options.min_disparity);
  apply_method(flags, options);
  if (flags.cost) options.cost = named(parse_cost(*flags.cost), *flags.cost, "--cost", "sad, ssd, mad");
  if (flags.implementation) {
    options.implementation = named(parse_implementation(*flags.implementation), *flags.implementation,
                                   "--implementation", "naive, sliding, simd");
  }
  if (flags.isa) {
    options.isa = named(parse_isa(*flags.isa), *flags.isa, "--isa", "auto, scalar, ssse3, sse41, avx2, neon");
  }
  if (const std::optional<std::string> problem = problem_with(options)) throw UsageError(*problem);
  return options;
}

RectifyConfig rectify_options(const Flags& flags, const Config& config) {
  RectifyConfig rectify = config.rectify;
  if (!flags.calibration && (flags.interpolation || flags.alpha)) {
    throw UsageError(std::string(flags.alpha ? "--alpha" : "--interpolation") +
                     ": belongs to --calibration, which is not there");
  }
  if (flags.interpolation) {
    rectify.interpolation = named(parse_interpolation(*flags.interpolation), *flags.interpolation,
                                  "--interpolation", "nearest, bilinear");
  }
  if (flags.alpha) rectify.alpha = flags.alpha;
  if (rectify.alpha && !(*rectify.alpha >= 0 && *rectify.alpha <= 1)) {
    throw UsageError("--alpha: 0 to 1 is allowed");
  }
  return rectify;
}

int in_range(int value, int least, int most, const char* flag) {
  if (value >= least && value <= most) return value;
  throw UsageError(std::string(flag) + ": is " + std::to_string(value) + "; " + std::to_string(least) +
                   " to " + std::to_string(most) + " is allowed");
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
  arguments.rectify = rectify_options(flags, config);
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
