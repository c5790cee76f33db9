// A matcher's whole input out of a string of bytes, for fuzzing.
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
  MatcherOptions options;  ///< problem_with() has none; implementation and isa are the default ones
  std::vector<int> cuts;   ///< rows, growing, inside the image, where bands begin and end
  std::optional<ValidityMask> left_mask, right_mask;
};

/// Any bytes make an input: sizes from 1×1 to 96×40, every option, pixels, masks, band cuts. What the bytes
/// do not say is zero. Nothing if the reference would take too long on it.
std::optional<MatcherInput> matcher_input(std::span<const std::uint8_t> bytes);

/// Matches the input with every implementation, instruction set and use of the caches, whole by 1 to 3
/// workers and in the bands of `cuts`, and compares with the naive implementation. A sentence that says what
/// differs, or nothing if all are equal.
std::optional<std::string> disagreement_on(const MatcherInput& input);

}  // namespace stereod
