// systemd's end of sd_notify(3), for tests.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace stereod {

/// While it lives, this process and the programs it starts find NOTIFY_SOCKET in their environment, and
/// WATCHDOG_USEC if `watchdog` is not 0. Keeps what they say.
class NotifySocket {
 public:
  /// The socket lies in `directory`.
  explicit NotifySocket(const std::filesystem::path& directory,
                        std::chrono::microseconds watchdog = std::chrono::microseconds(0));
  ~NotifySocket();
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// Waits until a message was received that begins with `beginning`, from this call on; false if none came
  /// in time. `meanwhile` is called all the while.
  bool wait_for(
      const std::string& beginning, std::chrono::seconds patience = std::chrono::seconds(60),
      const std::function<void()>& meanwhile = [] {});

  /// Receives for so long.
  void receive(
      std::chrono::milliseconds duration, const std::function<void()>& meanwhile = [] {});

  /// How many of the messages kept begin like this.
  int count(const std::string& beginning) const;
  /// The latest of them; empty if there is none.
  std::string latest(const std::string& beginning) const;
  /// Everything but the watchdog's and the status lines, in order; only first lines.
  std::vector<std::string> changes() const;
  void forget() { messages_.clear(); }

 private:
  bool receive_one(std::chrono::milliseconds patience);

  int fd_ = -1;
  std::vector<std::string> messages_;
};

}  // namespace stereod
