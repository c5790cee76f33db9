// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/url.h"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <stdexcept>

namespace stereod {
namespace {

constexpr int kMaxReceiveBuffer = 1 << 30;

[[noreturn]] void refuse(const std::string& url, const std::string& problem) {
  throw std::invalid_argument("LCM URL '" + url + "': " + problem);
}

/// Returns @p text as a decimal number in [min, max]; nothing if it is not one.
std::optional<int> parse_number(std::string_view text, int min, int max) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < min || value > max)
    return std::nullopt;
  return value;
}

std::vector<std::pair<std::string, std::string>> parse_options(std::string_view query) {
  std::vector<std::pair<std::string, std::string>> options;
  while (!query.empty()) {
    const std::string_view option = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), option.size() + 1));
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string_view value = option.substr(std::min(option.size(), equals + 1));
    if (!option.empty()) options.emplace_back(std::string(option.substr(0, equals)), std::string(value));
  }
  return options;
}

void check_number_option(const std::string& text, const std::string& key, const std::string& value, int max) {
  if (parse_number(value, 0, max)) return;
  refuse(text, key + " is '" + value + "', allowed 0…" + std::to_string(max));
}

void check_udpm(const std::string& text, const LcmUrl& url) {
  const std::size_t colon = std::min(url.network.find(':'), url.network.size());
  const std::string host = url.network.substr(0, colon);
  in_addr address{};
  if (inet_pton(AF_INET, host.c_str(), &address) != 1 || !IN_MULTICAST(ntohl(address.s_addr))) {
    refuse(text, "'" + host + "' is not a multicast address (224.0.0.0…239.255.255.255), for example " +
                     std::string(kDefaultLcmUrl));
  }
  if (colon < url.network.size() && !parse_number(url.network.substr(colon + 1), 1, 65535)) {
    refuse(text, "'" + url.network.substr(colon + 1) + "' is not a port, allowed 1…65535");
  }
  for (const auto& [key, value] : url.options) {
    if (key == "ttl") {
      check_number_option(text, key, value, 255);
    } else if (key == "recv_buf_size") {
      check_number_option(text, key, value, kMaxReceiveBuffer);
    } else {
      refuse(text, "unknown option '" + key + "', allowed ttl, recv_buf_size");
    }
  }
}

}  // namespace

std::optional<std::string> LcmUrl::option(std::string_view key) const {
  for (const auto& [name, value] : options) {
    if (name == key) return value;
  }
  return std::nullopt;
}

std::string LcmUrl::text() const {
  std::string result = provider + "://" + network;
  char separator = '?';
  for (const auto& [key, value] : options) {
    result.append(1, separator).append(key).append("=").append(value);
    separator = '&';
  }
  return result;
}

std::string effective_lcm_url(const std::string& url) {
  if (!url.empty()) return url;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  if (from_environment != nullptr && *from_environment != '\0') return from_environment;
  return std::string(kDefaultLcmUrl);
}

LcmUrl parse_lcm_url(const std::string& text) {
  const std::size_t separator = text.find("://");
  if (separator == std::string::npos) {
    refuse(text, "not of the form PROVIDER://NETWORK, for example " + std::string(kDefaultLcmUrl));
  }
  LcmUrl url;
  url.provider = text.substr(0, separator);
  const std::string rest = text.substr(separator + 3);
  const std::size_t question = std::min(rest.find('?'), rest.size());
  url.network = rest.substr(0, question);
  if (question < rest.size()) url.options = parse_options(std::string_view(rest).substr(question + 1));

  if (url.provider == "udpm") {
    check_udpm(text, url);
  } else if (url.provider == "file") {
    if (url.network.empty()) refuse(text, "the path of the log file is missing");
  } else if (url.provider != "memq") {
    refuse(text, "unknown provider '" + url.provider + "', allowed udpm, file, memq");
  }
  return url;
}

std::pair<std::string, int> udpm_address(const LcmUrl& url) {
  const std::size_t colon = std::min(url.network.find(':'), url.network.size());
  if (colon == url.network.size()) return {url.network, kDefaultLcmPort};
  return {url.network.substr(0, colon), std::stoi(url.network.substr(colon + 1))};
}

}  // namespace stereod
