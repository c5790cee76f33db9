// SPDX-License-Identifier: BSD-3-Clause
// Checks the network of this machine, for tests that need it.
#pragma once

#include <optional>
#include <string>

namespace stereod {

/// Returns why LCM's multicast group 239.255.76.67 cannot be used, for GTEST_SKIP; nothing if it works. Sends
/// one datagram that stays on this machine, to an unused port.
std::optional<std::string> why_no_multicast();

}  // namespace stereod
