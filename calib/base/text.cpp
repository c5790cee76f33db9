// SPDX-License-Identifier: BSD-3-Clause
#include "calib/base/text.h"

#include <cmath>

namespace stereod::calib {

std::string escape_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string format_length(double meters) {
  if (!std::isfinite(meters)) return "unknown";
  if (meters < 0.00995) return fixed(1000 * meters, meters < 0.000995 ? 2 : 1) + " mm";
  if (meters < 0.995) return fixed(100 * meters, meters < 0.0995 ? 1 : 0) + " cm";
  return fixed(meters, meters < 9.95 ? 1 : 0) + " m";
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = static_cast<std::uint32_t>(bytes[i]) << 16;
    if (i + 1 < bytes.size()) three |= static_cast<std::uint32_t>(bytes[i + 1]) << 8;
    if (i + 2 < bytes.size()) three |= bytes[i + 2];
    text += kDigits[three >> 18 & 63];
    text += kDigits[three >> 12 & 63];
    text += i + 1 < bytes.size() ? kDigits[three >> 6 & 63] : '=';
    text += i + 2 < bytes.size() ? kDigits[three & 63] : '=';
  }
  return text;
}

}  // namespace stereod::calib
