// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/service_manager.h"

#include <systemd/sd-daemon.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "daemon/base/clocks.h"

namespace stereod {

void ServiceManager::ready() {
  if (!std::exchange(ready_, true)) sd_notify(0, "READY=1");
}

void ServiceManager::reloading() {
  if (!ready_) return;
  const std::string since = std::to_string(monotonic_ns() / 1000);
  sd_notify(0, ("RELOADING=1\nMONOTONIC_USEC=" + since).c_str());
}

void ServiceManager::reloaded() {
  if (ready_) sd_notify(0, "READY=1");
}

void ServiceManager::stopping() { sd_notify(0, "STOPPING=1"); }

void ServiceManager::status(const std::string& line) {
  if (line == status_) return;
  status_ = line;
  std::string assignment = "STATUS=" + line;
  // A newline would begin another assignment.
  std::replace(assignment.begin(), assignment.end(), '\n', ' ');
  sd_notify(0, assignment.c_str());
}

void ServiceManager::alive() {
  std::uint64_t period_us = 0;
  if (sd_watchdog_enabled(0, &period_us) > 0) sd_notify(0, "WATCHDOG=1");
}

}  // namespace stereod
