// What stereo-match prints.
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/evaluation.h"

namespace stereod {

/// A table of some lines; `file` is the name of the ground truth, `grey_per_px` what evaluate() was given.
std::string evaluation_table(const Evaluation& evaluation, const std::string& file, double grey_per_px);

/// "median X ms, minimum Y ms" and a line break; the times are in milliseconds, at least one.
std::string timing_line(std::vector<double> times_ms);

}  // namespace stereod
