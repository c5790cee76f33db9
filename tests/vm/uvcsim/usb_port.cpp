// SPDX-License-Identifier: BSD-3-Clause
// Attaching to vhci-hcd, and the socket.
#include "tests/vm/uvcsim/usb_port.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>

namespace stereod::uvcsim {
namespace {

constexpr const char* kAttach = "/sys/devices/platform/vhci_hcd.0/attach";
constexpr int kHighSpeed = 3;  // enum usb_device_speed
constexpr int kAttempts = 100;

// Gives a socket to the kernel. Returns 0 or an errno value.
int attach(int port, int socket) {
  const int file = ::open(kAttach, O_WRONLY | O_CLOEXEC);
  if (file < 0) return errno;
  const std::string line = std::to_string(port) + " " + std::to_string(socket) + " " +
                           std::to_string((1 << 16) | (port + 1)) + " " + std::to_string(kHighSpeed);
  const int error = ::write(file, line.data(), line.size()) < 0 ? errno : 0;
  ::close(file);
  return error;
}

}  // namespace

void UsbPort::plug(int number) {
  unplug();
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "socketpair");
  }
  const int room = 4 << 20;  // more than a frame
  ::setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
  int error = attach(number, ends[1]);
  for (int i = 0; i < kAttempts && (error == EBUSY || error == EINVAL); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    error = attach(number, ends[1]);
  }
  ::close(ends[1]);
  socket_ = ends[0];
  if (error != 0) {
    unplug();
    throw std::system_error(error, std::generic_category(), std::string(kAttach) + ": is vhci-hcd loaded?");
  }
}

void UsbPort::unplug() {
  if (socket_ < 0) return;
  ::shutdown(socket_, SHUT_RDWR);
  ::close(socket_);
  socket_ = -1;
}

std::optional<UsbPort::Received> UsbPort::receive() {
  std::array<std::uint8_t, kUsbipHeader> header{};
  if (read_all(header.data(), header.size())) {
    if (const auto message = parse_usbip(header)) {
      Received received{*message, Bytes(message->payload())};
      if (read_all(received.data.data(), received.data.size())) return received;
    }
  }
  unplug();
  return std::nullopt;
}

void UsbPort::send(ByteSpan bytes) {
  while (!bytes.empty() && socket_ >= 0) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return unplug();
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
}

bool UsbPort::read_all(std::uint8_t* to, std::size_t count) {
  while (count > 0) {
    const ssize_t got = ::recv(socket_, to, count, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace stereod::uvcsim
