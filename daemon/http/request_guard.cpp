// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/http/request_guard.h"

#include <algorithm>
#include <string_view>

namespace stereod {
namespace {

std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const bool has_port = colon != std::string_view::npos &&
                        host.find_first_not_of("0123456789", colon + 1) == std::string_view::npos;
  return has_port ? host.substr(0, colon) : host;
}

}  // namespace

bool may_be_served(const RequestOrigin& request, const std::vector<std::string>& allowed_hosts) {
  const std::string_view name = without_port(request.host);
  const bool is_known = name == "127.0.0.1" || name == "localhost" ||
                        std::find(allowed_hosts.begin(), allowed_hosts.end(), name) != allowed_hosts.end();
  if (!is_known) return false;
  if (!request.origin.empty() && request.origin != "http://" + request.host) return false;
  return request.fetch_site.empty() || request.fetch_site == "same-origin" || request.fetch_site == "none";
}

}  // namespace stereod
