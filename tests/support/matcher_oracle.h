// The block matcher written a second time, straight from docs/matcher.md: slow, plain, and sharing no code
// with core/match but the struct of options. What it answers is what every implementation has to answer.
#pragma once

#include "core/match/disparity.h"
#include "core/match/options.h"

namespace stereod {

/// All of docs/matcher.md. Takes time in proportion to pixels × disparities × window². `implementation` and
/// `isa` make no difference; the options are not checked.
DisparityImage oracle_match(GrayView left, GrayView right, const MatcherOptions& options);

/// Section 1: the image that the search compares.
Image<int> oracle_prefilter(GrayView picture, const MatcherOptions& options);

/// Section 5, one filter each; `disparities` is what the sections before it have made.
DisparityImage oracle_median(const DisparityImage& disparities, int side);
DisparityImage oracle_speckle(const DisparityImage& disparities, int speckle_size,
                              int max_difference_in_units);

}  // namespace stereod
