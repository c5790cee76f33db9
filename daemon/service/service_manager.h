// What systemd wants to hear from a service of Type=notify.
#pragma once

#include <string>

namespace stereod {

/// The protocol of sd_notify(3). Where systemd has not asked for it (no NOTIFY_SOCKET in the environment)
/// nothing happens at all. One thread uses it.
class ServiceManager {
 public:
  /// The service does what it is there for; said once.
  void ready();
  /// The configuration is read again, and was. Nothing before it was ready.
  void reloading();
  void reloaded();
  /// It ends.
  void stopping();
  /// What it does, in words; said only when it changes. To be called once a second at most.
  void status(const std::string& sentence);
  /// It lives: systemd's watchdog begins to count anew. Nothing if there is no watchdog.
  void alive();

 private:
  bool ready_ = false;
  std::string said_;
};

}  // namespace stereod
