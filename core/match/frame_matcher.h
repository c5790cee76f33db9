// Matches whole images, cut into one band for each worker.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/worker_pool.h"
#include "core/match/band_matcher.h"
#include "core/match/speckle.h"

namespace stereod {

/// Matches pairs that lie in memory as a whole, as tools and tests have them. match() allocates nothing, but
/// for the naive semi-global matcher.
class FrameMatcher {
 public:
  /// For images of size `image`. Throws what make_band_matcher() throws. The pool outlives the matcher.
  FrameMatcher(const MatcherOptions& options, Size image, WorkerPool& pool);

  /// BandMatcher::use_masks().
  void use_masks(const ValidityMask* left, const ValidityMask* right) noexcept;

  /// Left and right are rectified and, like `out`, of the size given; `out` gets 1/units_per_pixel() px.
  void match(GrayView left, GrayView right, ImageView<std::int16_t> out);

 private:
  static void match_band(BandMatcher& matcher, GrayView left, GrayView right, RowRange rows,
                         ImageView<std::int16_t> out);

  MatcherOptions options_;
  Size image_;
  WorkerPool& pool_;
  std::vector<std::unique_ptr<BandMatcher>> matchers_;  // one for each worker
  std::optional<SpeckleFilter> speckle_filter_;
};

}  // namespace stereod
