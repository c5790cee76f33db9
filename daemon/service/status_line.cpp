// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/status_line.h"

#include <algorithm>
#include <cstdio>

namespace stereod {

std::string status_line(ServiceState state, const status_t& status) {
  std::string line(name_of(state));
  std::replace(line.begin(), line.end(), '_', ' ');
  const bool publishes = status.fps_out > 0;
  if (publishes) {
    char rate[64];
    std::snprintf(rate, sizeof rate, ": %.1f fps, latency %.0f ms", status.fps_out, status.latency_ms_median);
    line += rate;
  }
  if (!status.reason.empty()) line += (publishes ? "; " : ": ") + status.reason;
  return line;
}

}  // namespace stereod
