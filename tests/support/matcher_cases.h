// What the tests that hold the matcher to its oracle have in common.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/worker_pool.h"
#include "core/match/disparity.h"
#include "core/match/options.h"
#include "tests/support/random_images.h"
#include "tests/support/sanitized.h"

namespace stereod {

/// The instruction sets that this build has kernels for and this CPU can run.
const std::vector<Isa>& isas_that_run();

/// The same options for each implementation and instruction set that has to give the same answer.
std::vector<MatcherOptions> implementations_of(const MatcherOptions& options);

/// All options in one line.
std::string describe(const MatcherOptions& options);

/// A pool with this many workers, made once and kept.
WorkerPool& pool_of(int workers);

/// Whether the two are equal; if not, the first pixel that differs and how many do.
testing::AssertionResult same_disparities(const DisparityImage& oracle, DisparityView matched);

/// Matches `pair` with a matcher that has matched `before` already (unless that is empty) and compares with
/// `oracle`. The images lie in memory without padding, at odd addresses, and the answer between guard
/// values, so a read or write outside them is found.
testing::AssertionResult agrees(const DisparityImage& oracle, const StereoPair& pair,
                                const StereoPair& before, const MatcherOptions& options, int workers);

}  // namespace stereod
