// SPDX-License-Identifier: BSD-3-Clause
// The two halves of bench_thesis.
#pragma once

namespace stereod::bench {

/// Tables 3.1, 3.2, 3.4, 3.5 and figure 3.13, with `rounds` turns for each contestant. Says so and returns if
/// the images are not there. Throws std::runtime_error if the implementations disagree.
void measure_matching(int rounds);

/// Tables 4.2 and 4.3, likewise.
void measure_remapping(int rounds);

}  // namespace stereod::bench
