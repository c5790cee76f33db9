// SPDX-License-Identifier: BSD-3-Clause
// Matches whole images, cut into one band a worker.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/worker_pool.h"
#include "core/match/band_matcher.h"
#include "core/match/speckle.h"

namespace stereod {

/// Matches pairs that lie in memory as a whole, as tools and tests have them. match() allocates nothing,
/// except with the reference of the semi-global matcher.
class FrameMatcher {
 public:
  /// Allocates a band matcher for each worker of @p pool, which must outlive this object.
  /// @throws std::invalid_argument as make_band_matcher() does.
  FrameMatcher(const MatcherOptions& options, Size image, WorkerPool& pool);

  /// Sets the masks of both images, see BandMatcher::use_masks().
  void use_masks(const ValidityMask* left, const ValidityMask* right) noexcept;

  /// Matches a rectified pair and writes disparities [1/units_per_pixel() px] to @p out. All three have the
  /// size given to the constructor. Removes speckles last, if `speckle_size` > 0.
  void match(GrayView left, GrayView right, ImageView<std::int16_t> out);

 private:
  static void match_band(BandMatcher& matcher, GrayView left, GrayView right, RowRange rows,
                         ImageView<std::int16_t> out);

  MatcherOptions options_;
  Size image_;
  WorkerPool& pool_;
  std::vector<std::unique_ptr<BandMatcher>> matchers_;  // one a worker
  std::optional<SpeckleFilter> speckle_filter_;
};

}  // namespace stereod
