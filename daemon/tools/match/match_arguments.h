// SPDX-License-Identifier: BSD-3-Clause
// The command line of stereo-match.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>

#include "core/match/options.h"
#include "daemon/config/config.h"

namespace stereod::tools {

/// A command line that makes no sense; what() is one sentence.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

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

/// The text of --help, to print instead of matching.
struct TextToPrint {
  std::string text;
};

/// Parses the command line. Precedence of matcher and rectification settings: their own flags, then the preset, then the
/// configuration, then the defaults of the daemon. Throws UsageError; FileError for the configuration.
std::variant<MatchArguments, TextToPrint> parse_match_arguments(int argc, const char* const* argv);

}  // namespace stereod::tools
