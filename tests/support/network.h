// What this machine's network can do, for the tests that need it.
#pragma once

#include <optional>
#include <string>

namespace stereod {

/// Why LCM's multicast group 239.255.76.67 cannot be used here, as a sentence for GTEST_SKIP; nothing if what
/// is sent to it comes back. Sends one datagram that stays on this machine, to a port of its own.
std::optional<std::string> why_no_multicast();

}  // namespace stereod
