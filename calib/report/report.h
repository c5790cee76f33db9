// What a calibration is worth, as a page for a person.
#pragma once

#include <string>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/quality/coverage.h"
#include "calib/quality/depth_error.h"
#include "calib/quality/verdict.h"
#include "calib/solve/solve.h"

namespace stereod {

/// Everything that is said about a result, in the terminal and on the page.
struct Assessment {
  Coverage left, right;
  DepthErrorSources depth;
  Verdict verdict;
};
Assessment assess(const SolveResult& result);

/// The result in a few lines of text.
std::string summary_text(const SolveResult& result, const Assessment& assessment);

/// One HTML file that needs nothing else: verdict, coverage of both images, every pair's error, a rectified
/// pair with epipolar lines, the expected error of depth, the numbers. `images` are those of the result.
std::string report_page(const SolveResult& result, const Assessment& assessment,
                        const std::vector<ImagePair>& pictures);

}  // namespace stereod
