// SPDX-License-Identifier: BSD-3-Clause
// The semi-global matcher as docs/matcher.md defines it, in plain code.
#pragma once

#include "core/base/validity_mask.h"
#include "core/match/disparity.h"
#include "core/match/options.h"

namespace stereod {

/// Matches a rectified pair of one size [≥ 1×1 px]; each function does one step of docs/matcher.md, part 2.
/// Reference that SemiglobalMatcher must equal to the bit. @p options have no problem_with(); `speckle_size`
/// is ignored, see SpeckleFilter. A null mask takes every pixel for valid. Slow, and allocates memory for
/// every pixel and disparity.
DisparityImage semiglobal_reference(GrayView left, GrayView right, const MatcherOptions& options,
                                    const ValidityMask* left_mask, const ValidityMask* right_mask);

}  // namespace stereod
