// SPDX-License-Identifier: BSD-3-Clause
// Parses the command line of stereo-match.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "core/match/options.h"
#include "daemon/base/usage_error.h"
#include "daemon/config/config.h"

namespace stereod::tools {

struct RectifiedFiles {
  std::filesystem::path left;
  std::filesystem::path right;
};

struct MatchArguments {
  std::filesystem::path left;
  std::filesystem::path right;
  MatcherOptions matcher;
  int threads = 1;
  int repeat = 0;  ///< measured runs; 0: none
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> color;
  std::optional<RectifiedFiles> rectified;
  std::optional<std::filesystem::path> calibration;
  RectifyConfig rectify;  ///< used with a calibration
  std::optional<std::filesystem::path> ground_truth;
  double ground_truth_scale = 1;
};

/// Holds a text to print instead of matching: help or version.
struct TextToPrint {
  std::string text;
};

/// Parses the command line. The settings of matcher and rectification are the daemon's defaults, replaced by those of
/// the configuration file, replaced by those of the preset, each changed by its own flag.
/// @throws UsageError; FileError for the configuration file.
std::variant<MatchArguments, TextToPrint> parse_match_arguments(int argc, const char* const* argv);

}  // namespace stereod::tools
