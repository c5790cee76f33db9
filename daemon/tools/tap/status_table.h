// The daemon's status as a person reads it.
#pragma once

#include <string>
#include <vector>

#include "stereod/status_t.hpp"

namespace stereod {

/// Every field of the status as lines of at most about 80 columns: state and reason first, the cameras side
/// by side, then times, load and counts.
std::vector<std::string> status_lines(const status_t& status);

/// A length of time like "3 d 04 h", "1 h 02 min", "2 min 05 s" or "7 s".
std::string duration_in_words(double seconds);

}  // namespace stereod
