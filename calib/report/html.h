// Small pieces of text for pages and reports.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/text.h"

namespace stereod {

/// Safe as text and as an attribute's value.
std::string escaped(std::string_view text);

/// "3 mm", "4.2 cm", "1.3 m": two figures.
std::string length_in_words(double meters);

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace stereod
