// SPDX-License-Identifier: BSD-3-Clause
// Opens LCM, with errors that name the remedy.
#pragma once

#include <lcm/lcm.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "daemon/lcm/url.h"

namespace stereod {

/// Says why LCM cannot be used and what to do.
class BusError : public std::runtime_error {
 public:
  BusError(const std::string& message, bool permanent) : std::runtime_error(message), permanent_(permanent) {}
  /// Returns true if this URL can never work; false if it may work once the network (or disk) is ready.
  bool permanent() const noexcept { return permanent_; }

 private:
  bool permanent_;
};

struct LcmDeleter {
  void operator()(lcm_t* lcm) const noexcept { lcm_destroy(lcm); }
};
using LcmHandle = std::unique_ptr<lcm_t, LcmDeleter>;

/// Opens LCM. Checks for known failures (no multicast route, an unreadable file) first, because LCM would
/// only print lines of its own about them.
/// @throws BusError
LcmHandle open_lcm(const LcmUrl& url);

/// Returns parse_lcm_url(effective_lcm_url(url)).
/// @throws BusError (permanent) if the URL is invalid.
LcmUrl checked_lcm_url(const std::string& url);

}  // namespace stereod
