// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/view/json_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "daemon/base/text.h"

namespace stereod::tools {
namespace {

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : printable(text)) {  // no control characters, and UTF-8 throughout
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

template <typename Number>
std::string number_text(Number number) {
  if (!std::isfinite(number)) return "null";
  std::array<char, 40> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

}  // namespace

JsonObject& JsonObject::add_raw(std::string_view name, std::string_view value) {
  if (!body_.empty()) body_ += ',';
  body_.append("\"").append(name).append("\":").append(value);
  return *this;
}

JsonObject& JsonObject::add(std::string_view name, std::string_view text) {
  return add_raw(name, quoted(text));
}

JsonObject& JsonObject::add(std::string_view name, std::int64_t number) {
  return add_raw(name, std::to_string(number));
}

JsonObject& JsonObject::add(std::string_view name, double number) {
  return add_raw(name, number_text(number));
}

JsonObject& JsonObject::add(std::string_view name, const std::vector<float>& numbers) {
  std::string list = "[";
  for (const float number : numbers) list.append(list.size() > 1 ? "," : "").append(number_text(number));
  return add_raw(name, list + "]");
}

}  // namespace stereod::tools
