// Logging to stderr, for a person or for the journal.
#pragma once

#include <string>

namespace stereod {

/// Sets spdlog's default logger up: time, level and text; where journald reads, systemd's priority and text,
/// "<6>text", see sd-daemon(3). `level`: debug, info, warning or error.
/// Nothing on the per-frame path logs.
void set_up_log(const std::string& level);

/// Another level from now on. Any thread may be logging meanwhile.
void set_log_level(const std::string& level);

}  // namespace stereod
