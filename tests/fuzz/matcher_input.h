// SPDX-License-Identifier: BSD-3-Clause
// The complete input of a matcher from a string of bytes, for fuzzing.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/validity_mask.h"
#include "core/match/options.h"
#include "tests/support/random_images.h"

namespace stereod {

struct MatcherInput {
  StereoPair pair;
  MatcherOptions options;  ///< without problem_with(); implementation and isa are the defaults
  std::vector<int> cuts;   ///< ascending rows inside the image, where bands begin and end
  std::optional<ValidityMask> left_mask, right_mask;
};

/// Returns the input that @p bytes describe: sizes from 1×1 to 96×40, every option, pixels, masks, band cuts.
/// All strings are valid; missing bytes count as zero. Returns nullopt if the reference would take too long.
std::optional<MatcherInput> matcher_input(std::span<const std::uint8_t> bytes);

/// Matches @p input with every implementation, instruction set and cache use, as a whole with 1 to 3 workers
/// and in the bands of `cuts`, and compares with the naive implementation. Returns a sentence about the first
/// difference, or nullopt if all are equal.
std::optional<std::string> disagreement_on(const MatcherInput& input);

}  // namespace stereod
