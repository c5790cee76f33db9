// SPDX-License-Identifier: BSD-3-Clause
// Matches one made-up pair a given number of times and does nothing else, for programs that count
// instructions and cache misses: the difference of two runs is the difference of their repetitions.
//   matcher_once WIDTH HEIGHT DISPARITIES WINDOW MATCHER SUBPIXEL ISA CACHE REPETITIONS
// MATCHER: none or xsobel, the prefilter of the block matcher; coarse or fine, the grid of the semi-global
// one, which has no WINDOW and no CACHE.
#include <charconv>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/match/frame_matcher.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

constexpr std::string_view kUsage =
    "usage: matcher_once WIDTH HEIGHT DISPARITIES WINDOW none|xsobel|coarse|fine 0|1 ISA auto|large|small "
    "REPETITIONS";

int number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw std::invalid_argument("'" + std::string(text) + "' is not a whole number; " + std::string(kUsage));
  }
  return value;
}

/// What `parsed` holds, if it holds something.
template <typename Value>
Value known(std::optional<Value> parsed, std::string_view text) {
  if (!parsed) throw std::invalid_argument("'" + std::string(text) + "' is unknown; " + std::string(kUsage));
  return *parsed;
}

void run(const char* const* words) {
  const Size size{number(words[0]), number(words[1])};
  const std::optional<Grid> grid = parse_grid(words[4]);
  MatcherOptions options = grid ? matcher_preset("dense").value() : MatcherOptions{};
  options.disparities = number(words[2]);
  options.window = number(words[3]);
  if (grid) {
    options.grid = *grid;
  } else {
    options.prefilter = known(parse_prefilter(words[4]), words[4]);
  }
  options.subpixel = number(words[5]) != 0;
  options.isa = known(parse_isa(words[6]), words[6]);
  options.cache = known(parse_cache_use(words[7]), words[7]);
  const StereoPair pair = random_pair(Content::kSlantedPair, size, 1);
  WorkerPool pool(1);
  DisparityImage out(size);
  FrameMatcher matcher(options, size, pool);
  for (int i = number(words[8]); i > 0; --i) matcher.match(pair.left.view(), pair.right.view(), out.view());
}

}  // namespace
}  // namespace stereod

int main(int argc, char** argv) {
  constexpr int kWords = 9;
  try {
    if (argc != kWords + 1) throw std::invalid_argument(std::string(stereod::kUsage));
    stereod::run(argv + 1);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "matcher_once: %s\n", error.what());
    return 1;
  }
}
