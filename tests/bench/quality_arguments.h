// What depth_quality is asked to do.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/match/options.h"

namespace stereod::bench {

struct QualityArguments {
  std::vector<std::string> sets;                  ///< empty: all
  std::vector<std::string> matchers;              ///< empty: all
  std::optional<MatcherOptions> custom;           ///< the preset made of --base and --set
  std::optional<std::filesystem::path> pictures;  ///< the directory to write images into
};

/// Takes the command line apart. Prints its own help and ends the program if that is asked for. Throws
/// std::runtime_error with one sentence.
QualityArguments parse_quality_arguments(int argc, const char* const* argv);

}  // namespace stereod::bench
