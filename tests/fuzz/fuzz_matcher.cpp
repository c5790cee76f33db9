// SPDX-License-Identifier: BSD-3-Clause
// Entry of libFuzzer: all implementations of the matcher agree on any input.
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/matcher_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::optional<stereod::MatcherInput> input = stereod::matcher_input({data, size});
  if (!input) return 0;
  if (const std::optional<std::string> disagreement = stereod::disagreement_on(*input)) {
    std::fprintf(stderr, "%s\n", disagreement->c_str());
    std::abort();
  }
  return 0;
}
