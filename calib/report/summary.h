// SPDX-License-Identifier: BSD-3-Clause
// Summarizes a calibration for the terminal.
#pragma once

#include <string>

#include "calib/quality/assessment.h"

namespace stereod::calib {

/// Returns the result in about ten lines of text: verdict, pairs, errors, coverage, focal length, baseline and
/// expected depth errors.
std::string summary_text(const SolveResult& result, const Assessment& assessment);

}  // namespace stereod::calib
