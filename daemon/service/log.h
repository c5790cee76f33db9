// Logging to stderr, for a terminal or for the journal.
#pragma once

#include <string>

namespace stereod {

/// Sets spdlog's default logger up: on a terminal time, level and text; else (journald, a file) each line
/// begins with systemd's priority, "<6>text", see sd-daemon(3). `level`: debug, info, warning or error.
/// Nothing on the per-frame path logs.
void set_up_log(const std::string& level);

/// Another level from now on. Any thread may be logging meanwhile.
void set_log_level(const std::string& level);

}  // namespace stereod
