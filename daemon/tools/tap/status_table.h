// SPDX-License-Identifier: BSD-3-Clause
// Shows a status in a terminal.
#pragma once

#include <string>
#include <vector>

#include "stereod/status_t.hpp"

namespace stereod::tools {

/// Returns every field of the status as lines of at most 80 columns: state and reason, the cameras side by side, times, load,
/// counts.
std::vector<std::string> status_lines(const status_t& status);

/// Returns a duration like "3 d 04 h", "1 h 02 min", "2 min 05 s" or "7 s"; "-" if it is negative or not finite.
std::string duration_in_words(double seconds);

}  // namespace stereod::tools
