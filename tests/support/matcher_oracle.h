// SPDX-License-Identifier: BSD-3-Clause
// The oracle: the block matcher written a second time after docs/matcher.md, in plain code that shares only
// the options with core/match. Every implementation must equal it.
#pragma once

#include "core/match/disparity.h"
#include "core/match/options.h"

namespace stereod {

/// Matches a pair after part 1 of docs/matcher.md. Takes time proportional to pixels × disparities × window².
/// Ignores `implementation` and `isa`; does not check the options.
DisparityImage oracle_match(GrayView left, GrayView right, const MatcherOptions& options);

/// Returns the image that the search compares (section 1).
Image<int> oracle_prefilter(GrayView image, const MatcherOptions& options);

/// Apply one filter each (section 5) to the disparities of sections 2 to 4.
DisparityImage oracle_median(const DisparityImage& disparities, int side);
DisparityImage oracle_speckle(const DisparityImage& disparities, int speckle_size,
                              int max_difference_in_units);

}  // namespace stereod
