// SPDX-License-Identifier: BSD-3-Clause
// Converts sizes, numbers and lists to text for messages.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/base/image.h"

namespace stereod {

/// Returns the size as "640×480".
std::string to_string(Size size);

/// Returns the value with up to @p digits significant digits, without trailing zeros: "30", "7.5", "1e+06".
std::string significant(double value, int digits = 6);

/// Returns the words with @p separator between them, and @p last between the last two: "a, b or c" with " or ".
std::string joined(std::span<const std::string_view> words, std::string_view separator,
                   std::string_view last);
std::string joined(std::span<const std::string_view> words, std::string_view separator = ", ");

}  // namespace stereod
