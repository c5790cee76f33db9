// SPDX-License-Identifier: BSD-3-Clause
// Maps the values of an enumeration to names and back.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

namespace stereod {

/// A table of values and their names.
template <typename Enum, std::size_t N>
using EnumNames = std::array<std::pair<Enum, std::string_view>, N>;

/// Returns the name of @p value, or "?" if the table lacks it.
template <typename Enum, std::size_t N>
constexpr std::string_view find_name(const EnumNames<Enum, N>& names, Enum value) {
  for (const auto& [candidate, name] : names) {
    if (candidate == value) return name;
  }
  return "?";
}

/// Returns the value called @p name, or nullopt if the table lacks it.
template <typename Enum, std::size_t N>
constexpr std::optional<Enum> find_value(const EnumNames<Enum, N>& names, std::string_view name) {
  for (const auto& [value, candidate] : names) {
    if (candidate == name) return value;
  }
  return std::nullopt;
}

}  // namespace stereod
