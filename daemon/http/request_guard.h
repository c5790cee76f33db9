// SPDX-License-Identifier: BSD-3-Clause
// Which HTTP requests a local server answers.
#pragma once

#include <string>
#include <vector>

namespace stereod {

/// The headers that tell where a request comes from; empty: the request lacks the header.
struct RequestOrigin {
  std::string host;        ///< Host
  std::string origin;      ///< Origin
  std::string fetch_site;  ///< Sec-Fetch-Site
};

/// Returns whether a request may be answered. It must name this machine (127.0.0.1, localhost or one of
/// @p allowed_hosts, with any port), because a foreign name may be made to lead here (DNS rebinding). It must not come from
/// a page of another origin, because a page open elsewhere in the browser must not look through the cameras.
bool may_be_served(const RequestOrigin& request, const std::vector<std::string>& allowed_hosts);

}  // namespace stereod
