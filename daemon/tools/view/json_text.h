// SPDX-License-Identifier: BSD-3-Clause
// Writes JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace stereod::tools {

/// Builds one JSON object. Names must not need escaping; texts may come from the network.
class JsonObject {
 public:
  JsonObject& add(std::string_view name, std::string_view text);
  JsonObject& add(std::string_view name, const char* text) { return add(name, std::string_view(text)); }
  JsonObject& add(std::string_view name, std::int64_t number);
  JsonObject& add(std::string_view name, int number) { return add(name, std::int64_t{number}); }
  JsonObject& add(std::string_view name, bool value) { return add_raw(name, value ? "true" : "false"); }
  /// Adds the shortest text that reads back as the same number; null if it is not finite.
  JsonObject& add(std::string_view name, double number);
  JsonObject& add(std::string_view name, const std::vector<float>& numbers);
  JsonObject& add(std::string_view name, const JsonObject& object) { return add_raw(name, object.text()); }

  std::string text() const { return "{" + body_ + "}"; }

 private:
  JsonObject& add_raw(std::string_view name, std::string_view value);
  std::string body_;
};

}  // namespace stereod::tools
