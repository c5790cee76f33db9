// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/network.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace stereod {
namespace {

constexpr const char* kRemedy =
    "; run the tests with tests/run.sh, or in a namespace: unshare -rn sh -c 'ip link set lo up; ip route add "
    "224.0.0.0/4 dev lo; exec ctest'";

std::string because(const std::string& step) { return step + ": " + std::strerror(errno) + kRemedy; }

class Socket {
 public:
  Socket() : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  int fd() const { return fd_; }

 private:
  int fd_;
};

}  // namespace

std::optional<std::string> why_no_multicast() {
  const Socket receiver;
  const Socket sender;
  if (receiver.fd() < 0 || sender.fd() < 0) return because("no UDP socket");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t length = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (bind(receiver.fd(), generic, length) != 0) return because("no port for UDP");
  getsockname(receiver.fd(), generic, &length);  // the port the kernel chose

  ip_mreq group{};
  inet_pton(AF_INET, "239.255.76.67", &group.imr_multiaddr);
  if (setsockopt(receiver.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0) {
    return because("cannot join the multicast group 239.255.76.67");
  }
  const unsigned char ttl = 0;
  setsockopt(sender.fd(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  address.sin_addr = group.imr_multiaddr;
  if (sendto(sender.fd(), "?", 1, 0, generic, sizeof address) != 1) {
    return because("cannot send to the multicast group 239.255.76.67");
  }
  pollfd waiting{receiver.fd(), POLLIN, 0};
  if (poll(&waiting, 1, 1000) == 1) return std::nullopt;
  return std::string("datagrams sent to the multicast group 239.255.76.67 do not come back") + kRemedy;
}

}  // namespace stereod
