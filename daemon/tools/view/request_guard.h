// Who may look at the page.
#pragma once

#include <string>
#include <vector>

namespace stereod {

/// What of a request says where it comes from; empty: the header is not there.
struct RequestOrigin {
  std::string host;        ///< Host
  std::string origin;      ///< Origin
  std::string fetch_site;  ///< Sec-Fetch-Site
};

/// True if the request is for this machine by name (127.0.0.1, localhost or one of `allowed_hosts`), and not
/// made by a page of another origin: a page that a browser has open elsewhere must not look through the
/// robot's cameras, nor may a foreign name that was made to lead here (DNS rebinding).
bool may_be_served(const RequestOrigin& request, const std::vector<std::string>& allowed_hosts);

}  // namespace stereod
