// What stereo-match is asked to do.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "core/match/options.h"
#include "daemon/base/usage_error.h"
#include "daemon/config/config.h"

namespace stereod {

struct RectifiedFiles {
  std::filesystem::path left;
  std::filesystem::path right;
};

struct MatchArguments {
  std::filesystem::path left;
  std::filesystem::path right;
  MatcherOptions matcher;
  int threads = 1;
  int repeat = 0;  ///< measured runs; 0: nothing is measured
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> color;
  std::optional<RectifiedFiles> rectified;
  std::optional<std::filesystem::path> calibration;
  RectifyConfig rectify;  ///< used with a calibration
  std::optional<std::filesystem::path> ground_truth;
  double ground_truth_scale = 1;
};

/// Help or version: a text to print instead of working.
struct TextToPrint {
  std::string text;
};

/// Takes the command line apart. The settings of matcher and rectification are the daemon's defaults,
/// replaced by the configuration's, replaced by the preset's, then each changed by its own flag. Throws
/// UsageError, FileError for the configuration.
std::variant<MatchArguments, TextToPrint> parse_match_arguments(int argc, const char* const* argv);

}  // namespace stereod
