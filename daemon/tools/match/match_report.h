// SPDX-License-Identifier: BSD-3-Clause
// The output of stereo-match.
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/match/evaluation.h"

namespace stereod::tools {

/// Returns a table. @p title names the ground truth; @p gray_per_px as for evaluate().
std::string evaluation_table(const Evaluation& evaluation, const std::string& title, double gray_per_px);

/// Returns a line with the shares of @p measured and @p filled pixels of @p all [px], which the files do not distinguish.
std::string filled_line(long measured, long filled, long all);

/// Returns "median X ms, minimum Y ms" and a line break. @p times_ms: at least one.
std::string timing_line(std::vector<double> times_ms);

}  // namespace stereod::tools
