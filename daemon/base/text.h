// SPDX-License-Identifier: BSD-3-Clause
// Converts numbers to text and makes text safe and fit for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/text.h"

namespace stereod {

/// Returns the value with @p digits digits after the point, "-" if it is not finite.
std::string fixed(double value, int digits);

/// Returns the shortest decimal number that reads back to the same bits.
std::string exact(double value);

/// Returns text of unknown origin in a form that is safe on a terminal: control characters (escape sequences
/// among them) and bytes that are not UTF-8 become '?'.
std::string printable(std::string_view text);

/// Returns the number of terminal columns that printable text takes: one for each character.
std::size_t display_width(std::string_view text);

/// Breaks text at spaces into one or more lines of up to @p width columns; a longer word is cut.
std::vector<std::string> wrapped(std::string_view text, std::size_t width);

}  // namespace stereod
