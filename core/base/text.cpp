// SPDX-License-Identifier: BSD-3-Clause
#include "core/base/text.h"

#include <array>
#include <cstddef>
#include <cstdio>

namespace stereod {

std::string to_string(Size size) { return std::to_string(size.width) + "×" + std::to_string(size.height); }

std::string significant(double value, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string joined(std::span<const std::string_view> words, std::string_view separator,
                   std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 < words.size() ? separator : last;
    text += words[i];
  }
  return text;
}

std::string joined(std::span<const std::string_view> words, std::string_view separator) {
  return joined(words, separator, separator);
}

}  // namespace stereod
