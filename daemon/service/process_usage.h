// What this process takes of the machine.
#pragma once

#include <cstdint>

namespace stereod {

/// CPU time of all threads since the start, s.
double process_cpu_seconds();

/// Resident memory, MB (10^6 bytes); 0 if /proc is not there.
double process_rss_mb();

}  // namespace stereod
