// What stereo-match prints.
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/match/evaluation.h"

namespace stereod {

/// A table of some lines; `file` is the name of the ground truth, `gray_per_px` what evaluate() was given.
std::string evaluation_table(const Evaluation& evaluation, const std::string& file, double gray_per_px);

/// What to say where filled pixels were written: how many are measured, as the files do not tell them apart.
/// `measured` and `filled` are numbers of pixels.
std::string filled_line(long measured, long filled, long all);

/// "median X ms, minimum Y ms" and a line break; the times are in milliseconds, at least one.
std::string timing_line(std::vector<double> times_ms);

}  // namespace stereod
