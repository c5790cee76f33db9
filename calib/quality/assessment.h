// SPDX-License-Identifier: BSD-3-Clause
// Assesses a calibration.
#pragma once

#include "calib/quality/coverage.h"
#include "calib/quality/depth_error.h"
#include "calib/quality/verdict.h"
#include "calib/solve/solve.h"

namespace stereod::calib {

/// The assessment that terminal and report show.
struct Assessment {
  Coverage left, right;  ///< of the used pairs
  DepthErrorSources depth;
  Verdict verdict;
};

/// Assesses @p result by its used pairs and the errors measured on held-out pairs.
Assessment assess(const SolveResult& result);

}  // namespace stereod::calib
