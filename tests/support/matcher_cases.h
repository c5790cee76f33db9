// SPDX-License-Identifier: BSD-3-Clause
// Shared by the tests that compare the matchers with their oracle.
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

/// Returns the instruction sets that this build has kernels for and this CPU can run, and kAuto.
const std::vector<Isa>& isas_that_run();

/// Returns @p options for each implementation and instruction set that must give the same result.
std::vector<MatcherOptions> implementations_of(const MatcherOptions& options);

/// Returns all options in one line.
std::string describe(const MatcherOptions& options);

/// Returns a pool of @p workers workers, which lives until the program ends.
WorkerPool& pool_of(int workers);

/// Succeeds if both are equal; else names the first pixel that differs and the number of such pixels.
testing::AssertionResult same_disparities(const DisparityImage& oracle, DisparityView matched);

/// Matches @p pair with a matcher that has matched @p before first (unless that is empty) and compares the
/// result with @p oracle. The images lie in memory without padding, at odd addresses, and the result between
/// guard values, so that accesses outside are detected.
testing::AssertionResult agrees(const DisparityImage& oracle, const StereoPair& pair,
                                const StereoPair& before, const MatcherOptions& options, int workers);

}  // namespace stereod
