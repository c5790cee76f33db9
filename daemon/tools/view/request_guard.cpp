#include "daemon/tools/view/request_guard.h"

#include <algorithm>
#include <string_view>

namespace stereod {
namespace {

/// `host` without its port.
std::string_view name_of(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const bool port = colon != std::string_view::npos &&
                    host.find_first_not_of("0123456789", colon + 1) == std::string_view::npos;
  return port ? host.substr(0, colon) : host;
}

}  // namespace

bool may_be_served(const RequestOrigin& request, const std::vector<std::string>& allowed_hosts) {
  const std::string_view name = name_of(request.host);
  const bool known = name == "127.0.0.1" || name == "localhost" ||
                     std::find(allowed_hosts.begin(), allowed_hosts.end(), name) != allowed_hosts.end();
  if (!known) return false;
  if (!request.origin.empty() && request.origin != "http://" + request.host) return false;
  return request.fetch_site.empty() || request.fetch_site == "same-origin" || request.fetch_site == "none";
}

}  // namespace stereod
