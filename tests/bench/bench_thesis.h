// SPDX-License-Identifier: BSD-3-Clause
// The two halves of bench_thesis.
#pragma once

namespace stereod::bench {

/// Measures tables 3.1, 3.2, 3.4, 3.5 and figure 3.13, with @p rounds turns for each contestant. Prints a
/// message and returns if the images are missing. Throws std::runtime_error if the implementations disagree.
void measure_matching(int rounds);

/// Measures tables 4.2 and 4.3, with @p rounds turns for each contestant.
void measure_remapping(int rounds);

}  // namespace stereod::bench
