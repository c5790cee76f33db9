#include "core/match/band_matcher.h"

#include <stdexcept>
#include <string>

#include "core/match/block_matcher.h"
#include "core/match/isa.h"
#include "core/match/semiglobal/semiglobal_matcher.h"

namespace stereod {

std::unique_ptr<BandMatcher> make_band_matcher(const MatcherOptions& options, Size image) {
  if (const auto problem = problem_with(options)) throw std::invalid_argument(*problem);
  if (image.width < 1 || image.height < 1)
    throw std::invalid_argument("an image to match has at least one pixel");
  if (options.implementation == Implementation::kSimd) resolve_isa(options.isa);
  if (options.method == Method::kBlock) return std::make_unique<BlockMatcher>(options, image);
  if (options.implementation == Implementation::kNaive)
    return make_defined_semiglobal_matcher(options, image);
  return std::make_unique<SemiglobalMatcher>(options, image);
}

}  // namespace stereod
