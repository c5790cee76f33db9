// SPDX-License-Identifier: BSD-3-Clause
// Logging to stderr, for a terminal or the journal.
#pragma once

#include <string>

namespace stereod {

/// Installs spdlog's default logger: time, level and text on a terminal; on the journal systemd's priority
/// and text ("<6>text", sd-daemon(3)). Lines are dropped while stderr is blocked. @p level is debug, info,
/// warning or error. The per-frame path does not log.
void set_up_log(const std::string& level);

/// Changes the level. Other threads may log meanwhile.
void set_log_level(const std::string& level);

}  // namespace stereod
