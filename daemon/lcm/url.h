// LCM URLs: checked before LCM sees them, because it takes nonsense (a port of 0, a time to live of "abc")
// without a word, or answers on stderr.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stereod {

/// An LCM URL, `provider://network?key=value&key=value`, in its parts.
struct LcmUrl {
  std::string provider;  ///< udpm, file or memq
  std::string network;   ///< udpm: address or address:port; file: the path; memq: empty
  std::vector<std::pair<std::string, std::string>> options;

  /// The value of an option; nothing if the URL does not have it.
  std::optional<std::string> option(std::string_view key) const;
  std::string text() const;
};

inline constexpr std::string_view kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";
inline constexpr int kDefaultLcmPort = 7667;

/// The URL that counts: `url`, or if it is empty the environment's LCM_DEFAULT_URL, or else kDefaultLcmUrl
/// (this machine only). LCM's own rule.
std::string effective_lcm_url(const std::string& url);

/// Takes a URL apart. Throws std::invalid_argument with one sentence that names the URL, what is wrong with
/// it and what is allowed. Providers that make publishing wait for a server or subscribe by themselves (tcpq,
/// mpudpm) are refused.
LcmUrl parse_lcm_url(const std::string& url);

/// Host and port of a checked udpm URL.
std::pair<std::string, int> udpm_address(const LcmUrl& url);

}  // namespace stereod
