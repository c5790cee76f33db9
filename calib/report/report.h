// SPDX-License-Identifier: BSD-3-Clause
// Renders the calibration report, one HTML page.
#pragma once

#include <string>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/quality/assessment.h"

namespace stereod::calib {

/// Returns a self-contained HTML page: verdict, coverage of both images, the errors of every pair, a rectified pair
/// with epipolar lines, the expected depth error and all parameters. @p images are those that were solved from.
std::string report_page(const SolveResult& result, const Assessment& assessment,
                        const std::vector<ImagePair>& images);

}  // namespace stereod::calib
