// SPDX-License-Identifier: BSD-3-Clause
// Lists the keys and values of the configuration that have new names, for hints.
#pragma once

#include <span>
#include <string_view>

namespace stereod {

struct RenamedKey {
  std::string_view old_key, new_key;  ///< with the sections: "rectify.zoom"
};

struct RenamedValue {
  std::string_view key;  ///< by its new name
  std::string_view old_value, new_value;
};

/// Return all renamed keys and values. Old names are not read; they only get a hint.
std::span<const RenamedKey> renamed_keys();
std::span<const RenamedValue> renamed_values();

/// Returns the new name, empty if nothing was renamed.
std::string_view new_key(std::string_view old_key);
std::string_view new_value(std::string_view key, std::string_view old_value);

}  // namespace stereod
