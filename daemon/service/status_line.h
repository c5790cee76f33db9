// The daemon's status in one line, for systemctl.
#pragma once

#include <string>

#include "stereod/status_t.hpp"

namespace stereod {

/// "Streaming: 30.0 frames a second, 12 ms from exposure to the last row."
std::string status_line(const status_t& status);

}  // namespace stereod
