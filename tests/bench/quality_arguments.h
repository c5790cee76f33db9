// SPDX-License-Identifier: BSD-3-Clause
// The command line of depth_quality.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/match/options.h"

namespace stereod::bench {

struct QualityArguments {
  std::vector<std::string> sets;                         ///< empty: all
  std::vector<std::string> matchers;                     ///< empty: all
  std::optional<MatcherOptions> custom;                  ///< the preset made of --base and --set
  std::optional<std::filesystem::path> image_directory;  ///< where to write images; none: writes none
};

/// Parses the command line. --help prints the help and ends the program. Throws std::runtime_error with one
/// sentence.
QualityArguments parse_quality_arguments(int argc, const char* const* argv);

}  // namespace stereod::bench
