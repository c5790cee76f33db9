// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/notify_socket.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace stereod {
namespace {

constexpr std::chrono::milliseconds kStep{10};

bool begins(const std::string& message, const std::string& beginning) {
  return message.rfind(beginning, 0) == 0;
}

}  // namespace

NotifySocket::NotifySocket(const std::filesystem::path& directory, std::chrono::microseconds watchdog)
    : fd_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  const std::string path = (directory / "notify").string();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) throw std::runtime_error(path + " is too long for a socket");
  std::memcpy(address.sun_path, path.c_str(), path.size());
  if (bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("cannot create a socket at " + path);
  }
  ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  if (watchdog.count() > 0) ::setenv("WATCHDOG_USEC", std::to_string(watchdog.count()).c_str(), 1);
}

NotifySocket::~NotifySocket() {
  ::unsetenv("NOTIFY_SOCKET");
  ::unsetenv("WATCHDOG_USEC");
  close(fd_);
}

bool NotifySocket::receive_one(std::chrono::milliseconds patience) {
  pollfd ready{fd_, POLLIN, 0};
  if (poll(&ready, 1, static_cast<int>(patience.count())) != 1) return false;
  std::array<char, 8192> buffer{};
  const ssize_t size = recv(fd_, buffer.data(), buffer.size(), 0);
  if (size > 0) messages_.emplace_back(buffer.data(), static_cast<std::size_t>(size));
  return size > 0;
}

bool NotifySocket::wait_for(const std::string& beginning, std::chrono::seconds patience,
                            const std::function<void()>& meanwhile) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < deadline) {
    meanwhile();
    if (receive_one(kStep) && begins(messages_.back(), beginning)) return true;
  }
  return false;
}

void NotifySocket::receive(std::chrono::milliseconds duration, const std::function<void()>& meanwhile) {
  const auto deadline = std::chrono::steady_clock::now() + duration;
  while (std::chrono::steady_clock::now() < deadline) {
    meanwhile();
    receive_one(kStep);
  }
}

int NotifySocket::count(const std::string& beginning) const {
  return static_cast<int>(std::count_if(messages_.begin(), messages_.end(), [&](const std::string& message) {
    return begins(message, beginning);
  }));
}

std::string NotifySocket::latest(const std::string& beginning) const {
  const auto found = std::find_if(messages_.rbegin(), messages_.rend(),
                                  [&](const std::string& message) { return begins(message, beginning); });
  return found == messages_.rend() ? "" : *found;
}

std::vector<std::string> NotifySocket::changes() const {
  std::vector<std::string> changes;
  for (const std::string& message : messages_) {
    if (begins(message, "STATUS=") || begins(message, "WATCHDOG=")) continue;
    changes.push_back(message.substr(0, message.find('\n')));
  }
  return changes;
}

}  // namespace stereod
