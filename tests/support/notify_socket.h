// SPDX-License-Identifier: BSD-3-Clause
// The receiving end of sd_notify(3), for tests.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace stereod {

/// Sets NOTIFY_SOCKET, and WATCHDOG_USEC if `watchdog` is not 0, in the environment of this process and the
/// programs it starts, for its lifetime. Keeps the messages it receives.
class NotifySocket {
 public:
  /// Creates the socket in @p directory.
  explicit NotifySocket(const std::filesystem::path& directory,
                        std::chrono::microseconds watchdog = std::chrono::microseconds(0));
  ~NotifySocket();
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// Waits for a message that starts with @p beginning; messages before this call do not count. Calls @p
  /// meanwhile repeatedly. Returns false if none arrived in time.
  bool wait_for(
      const std::string& beginning, std::chrono::seconds patience = std::chrono::seconds(60),
      const std::function<void()>& meanwhile = [] {});

  /// Receives messages for @p duration.
  void receive(
      std::chrono::milliseconds duration, const std::function<void()>& meanwhile = [] {});

  /// Returns how many of the kept messages start with @p beginning.
  int count(const std::string& beginning) const;
  /// Returns the latest of them; empty if there is none.
  std::string latest(const std::string& beginning) const;
  /// Returns the first lines of all messages in order, without watchdog pings and status lines.
  std::vector<std::string> changes() const;
  void forget() { messages_.clear(); }

 private:
  bool receive_one(std::chrono::milliseconds patience);

  int fd_ = -1;
  std::vector<std::string> messages_;
};

}  // namespace stereod
