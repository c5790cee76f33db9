// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base/stop_signals.h"

#include <ctime>

namespace stereod {

StopSignals::StopSignals() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

bool StopSignals::arrived() {
  const timespec no_wait{};
  if (!arrived_) arrived_ = sigtimedwait(&signals_, nullptr, &no_wait) > 0;
  return arrived_;
}

}  // namespace stereod
