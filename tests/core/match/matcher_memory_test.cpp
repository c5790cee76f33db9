// SPDX-License-Identifier: BSD-3-Clause
// The scratch memory of the matchers.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/match/band_matcher.h"

namespace stereod {
namespace {

// At 640×480 with 64 disparities the memory of a worker fits in a second-level cache of 1 MiB, and with
// CacheUse::kSmall in half of it, which two workers share.
TEST(MatcherMemory, Scratch_FitsInCache) {
  constexpr std::size_t kMiB = 1024 * 1024;
  std::vector<std::pair<std::string, MatcherOptions>> settings;
  for (const char* preset : {"thesis", "fast", "robust"})
    settings.emplace_back(preset, *matcher_preset(preset));
  settings.emplace_back("thesis with 17 x 17", *matcher_preset("thesis"));
  settings.back().second.window = 17;  // whose costs do not fit in 16 bits
  for (auto& [preset, options] : settings) {
    options.cache = CacheUse::kLarge;
    const std::size_t large = make_band_matcher(options, {640, 480})->scratch_bytes();
    options.cache = CacheUse::kSmall;
    const std::size_t small = make_band_matcher(options, {640, 480})->scratch_bytes();
    EXPECT_LT(large, kMiB) << preset;
    EXPECT_LT(small, kMiB / 2) << preset;
    RecordProperty(preset, std::to_string(large) + " and " + std::to_string(small) + " bytes");
  }
}

TEST(MatcherMemory, SemiglobalScratch_IsSmaller) {
  for (const Isa isa : {Isa::kAuto, Isa::kScalar}) {  // vectors of 32 bytes, if available, and of 16
    for (const auto& [preset, maximum] :
         {std::pair("robust", 300'000U), {"dense", 300'000U}, {"fine", 550'000U}}) {
      MatcherOptions options = *matcher_preset(preset);
      options.isa = isa;
      EXPECT_LE(make_band_matcher(options, {640, 480})->scratch_bytes(), maximum) << preset;
    }
  }
}

}  // namespace
}  // namespace stereod
