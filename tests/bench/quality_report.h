// SPDX-License-Identifier: BSD-3-Clause
// The tables and sentences of depth_quality.
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/match/evaluation.h"

namespace stereod::bench {

using tools::evaluate;
using tools::Evaluation;

struct SetResult {
  std::string set;
  Evaluation evaluation;
};

/// The results of one matcher; all matchers have the same sets in the same order, at least one.
struct MatcherResult {
  std::string name;
  std::string settings;
  std::vector<SetResult> sets;
};

/// Prints a line for each set and the mean over the sets, with the difference from @p bm.
void print_table(const MatcherResult& result, const MatcherResult& bm);

/// Prints on how many sets the matcher has lower bad-1 over matched pixels and at least the density of
/// @p bm, and the other sets.
void print_trust_against(const MatcherResult& result, const MatcherResult& bm);

/// Prints by how much the matcher's mean bad-1 over all known pixels is below that of @p bm, and on how many
/// sets.
void print_coverage_against(const MatcherResult& result, const MatcherResult& bm);

/// Prints one line for each result on its first set: bad-1, density and mean squared difference.
void print_squared_differences(const std::vector<MatcherResult>& results);

}  // namespace stereod::bench
