// SPDX-License-Identifier: BSD-3-Clause
// The status in one line, for systemctl.
#pragma once

#include <string>

#include "daemon/service/service_state.h"
#include "stereod/status_t.hpp"

namespace stereod {

/// Returns a line like "streaming: 30.0 fps, latency 12 ms" or "waiting for cameras: no frames from the left
/// camera". The latency is the median from exposure to the last row sent.
std::string status_line(ServiceState state, const status_t& status);

}  // namespace stereod
