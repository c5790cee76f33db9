// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/handle.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>

namespace stereod {
namespace {

/// Returns 0, or the errno of connecting a UDP socket to the multicast group: sends nothing, but the kernel
/// looks for a route.
int route_error(const LcmUrl& url) {
  const auto [host, port] = udpm_address(url);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, host.c_str(), &address.sin_addr);
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return errno;
  const int result = connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  const int error = result == 0 ? 0 : errno;
  close(fd);
  return error;
}

void check_route(const LcmUrl& url) {
  const int error = route_error(url);
  if (error == 0) return;
  if (error == ENETUNREACH) {
    throw BusError(
        "LCM URL '" + url.text() +
            "': no route to the multicast group: for this machine only, run 'sudo ip "
            "route add 224.0.0.0/4 dev lo' (after 'sudo ip link set lo up' if the loopback interface is down)",
        false);
  }
  throw BusError(
      "LCM URL '" + url.text() + "': the multicast group cannot be reached: " + std::strerror(error), false);
}

/// Checks that a log to read is readable, or that the directory of a log to write is writable.
void check_log_file(const LcmUrl& url) {
  const std::filesystem::path file = url.network;
  const bool reads = url.option("mode").value_or("r") == "r";
  const std::filesystem::path needed = reads ? file : std::filesystem::absolute(file).parent_path();
  if (access(needed.c_str(), reads ? R_OK : W_OK) == 0) return;
  throw BusError("LCM URL '" + url.text() + "': " + needed.string() + ": " + std::strerror(errno), false);
}

}  // namespace

LcmUrl checked_lcm_url(const std::string& url) {
  try {
    return parse_lcm_url(effective_lcm_url(url));
  } catch (const std::invalid_argument& error) {
    throw BusError(error.what(), true);
  }
}

LcmHandle open_lcm(const LcmUrl& url) {
  if (url.provider == "udpm") check_route(url);
  if (url.provider == "file") check_log_file(url);
  LcmHandle lcm(lcm_create(url.text().c_str()));
  if (lcm) return lcm;
  const std::string what = url.provider == "file" ? ": the log file cannot be opened" : ": LCM refused it";
  throw BusError("LCM URL '" + url.text() + "'" + what, false);
}

}  // namespace stereod
