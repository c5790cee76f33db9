// SPDX-License-Identifier: BSD-3-Clause
// CPU time and memory of this process.
#pragma once

#include <cstdint>

namespace stereod {

/// Returns the CPU time of all threads since the start [s].
double process_cpu_seconds();

/// Returns the resident memory [MB = 10^6 bytes]; 0 if /proc is missing.
double process_rss_mb();

}  // namespace stereod
