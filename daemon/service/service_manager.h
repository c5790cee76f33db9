// SPDX-License-Identifier: BSD-3-Clause
// Notifications to systemd for a service of Type=notify.
#pragma once

#include <string>

namespace stereod {

/// Implements the protocol of sd_notify(3). Does nothing unless systemd asks for it (NOTIFY_SOCKET in the
/// environment). One thread uses it.
class ServiceManager {
 public:
  /// Reports that the service is ready; only the first call does.
  void ready();
  /// Report the begin and the end of a reload. Do nothing before ready().
  void reloading();
  void reloaded();
  /// Reports that the service stops.
  void stopping();
  /// Sets the status line of systemctl. Sends only changes. Call it at most once a second.
  void status(const std::string& line);
  /// Restarts the timeout of systemd's watchdog. Does nothing without a watchdog.
  void alive();

 private:
  bool ready_ = false;
  std::string status_;  // as last sent
};

}  // namespace stereod
