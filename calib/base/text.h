// SPDX-License-Identifier: BSD-3-Clause
// Text for the terminal, the report and the printed board.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/text.h"

namespace stereod::calib {

/// Returns @p text with &, <, > and " escaped for HTML and SVG, as content or as an attribute's value.
std::string escape_html(std::string_view text);

/// Returns @p meters with two significant digits and a suitable unit: "3.4 mm", "42 cm", "1.3 m"; "unknown"
/// unless finite.
std::string format_length(double meters);

/// Returns the base64 encoding of @p bytes (RFC 4648).
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace stereod::calib
