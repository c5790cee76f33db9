// SPDX-License-Identifier: BSD-3-Clause
// Defines what is wrong with a setting.
#pragma once

#include <string>

namespace stereod {

/// Describes a setting that cannot be used. The caller adds the place: "file:line: key: message", "--key: message".
struct Problem {
  std::string key;      ///< such as "disparities"
  std::string message;  ///< the value found and the values allowed: "found 300, allowed 1…256"
  friend bool operator==(const Problem&, const Problem&) = default;
};

/// Returns "key: message".
inline std::string to_string(const Problem& problem) { return problem.key + ": " + problem.message; }

}  // namespace stereod
