// The semi-global matcher as docs/matcher.md defines it, in plain code that takes its time.
#pragma once

#include "core/match/disparity.h"
#include "core/match/options.h"
#include "core/base/validity_mask.h"

namespace stereod {

/// Matches a whole rectified pair of one size (≥ 1×1); every step is a function that does what the page says.
/// The options have no problem_with(); `speckle_size` is left to whoever has the whole image. A null mask
/// holds every pixel for valid. Takes memory for every pixel and disparity.
DisparityImage semiglobal_by_definition(GrayView left, GrayView right, const MatcherOptions& options,
                                        const ValidityMask* left_mask, const ValidityMask* right_mask);

}  // namespace stereod
