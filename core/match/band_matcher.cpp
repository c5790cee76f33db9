// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/band_matcher.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/base/cpu.h"
#include "core/base/text.h"
#include "core/match/block/block_matcher.h"
#include "core/match/semiglobal/semiglobal_matcher.h"

namespace stereod {

std::unique_ptr<BandMatcher> make_band_matcher(const MatcherOptions& options, Size image) {
  if (const auto problem = problem_with(options)) throw std::invalid_argument(to_string(*problem));
  constexpr int kMaxSide = std::numeric_limits<std::int16_t>::max();
  if (std::min(image.width, image.height) < 1 || std::max(image.width, image.height) > kMaxSide) {
    throw std::invalid_argument("an image to match has 1 to " + std::to_string(kMaxSide) +
                                " pixels a side, not " + to_string(image));
  }
  if (options.implementation == Implementation::kSimd) resolve_isa(options.isa);
  if (options.method == Method::kBlock) return std::make_unique<BlockMatcher>(options, image);
  if (options.implementation == Implementation::kNaive)
    return make_reference_semiglobal_matcher(options, image);
  return std::make_unique<SemiglobalMatcher>(options, image);
}

}  // namespace stereod
