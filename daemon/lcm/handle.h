// Opening LCM, with errors a person can act on.
#pragma once

#include <lcm/lcm.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "daemon/lcm/url.h"

namespace stereod {

/// Why LCM cannot be opened: one sentence, with the remedy.
class BusError : public std::runtime_error {
 public:
  BusError(const std::string& sentence, bool permanent)
      : std::runtime_error(sentence), permanent_(permanent) {}
  /// True if it can never work with this URL; false if it may once the machine's network (or disk) is ready.
  bool permanent() const noexcept { return permanent_; }

 private:
  bool permanent_;
};

struct LcmDeleter {
  void operator()(lcm_t* lcm) const noexcept { lcm_destroy(lcm); }
};
using LcmHandle = std::unique_ptr<lcm_t, LcmDeleter>;

/// Opens LCM. What is known to fail (a bad URL, no route for multicast) is found out first, so that LCM does
/// not print its own lines about it. Throws BusError.
LcmHandle open_lcm(const LcmUrl& url);

/// parse_lcm_url(effective_lcm_url(url)), with its exception turned into a permanent BusError.
LcmUrl checked_lcm_url(const std::string& url);

}  // namespace stereod
