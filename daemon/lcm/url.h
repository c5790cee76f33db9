// SPDX-License-Identifier: BSD-3-Clause
// Parses and checks LCM URLs. LCM itself accepts nonsense (port 0, ttl=abc) silently or complains on stderr.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stereod {

/// The parts of an LCM URL, `provider://network?key=value&key=value`.
struct LcmUrl {
  std::string provider;  ///< udpm, file or memq
  std::string network;   ///< udpm: address or address:port; file: the path; memq: empty
  std::vector<std::pair<std::string, std::string>> options;

  /// Returns the value of an option; nothing if the URL does not have it.
  std::optional<std::string> option(std::string_view key) const;
  /// Returns the URL as text.
  std::string text() const;
};

inline constexpr std::string_view kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";
inline constexpr int kDefaultLcmPort = 7667;

/// Returns @p url; if it is empty, the environment's LCM_DEFAULT_URL; if that is empty, kDefaultLcmUrl (this
/// machine only). This is LCM's own rule.
std::string effective_lcm_url(const std::string& url);

/// Parses a URL. Refuses the providers tcpq, which makes publishing wait for a server, and mpudpm, which
/// subscribes.
/// @throws std::invalid_argument that names the URL, what was found and what is allowed.
LcmUrl parse_lcm_url(const std::string& url);

/// Returns host and port of a checked udpm URL.
std::pair<std::string, int> udpm_address(const LcmUrl& url);

}  // namespace stereod
