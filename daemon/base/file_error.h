// SPDX-License-Identifier: BSD-3-Clause
// Defines the exception for files that cannot be used.
#pragma once

#include <stdexcept>

namespace stereod {

/// Reports a file that is missing, unreadable or malformed. what() names the file, the value found and the value
/// allowed.
class FileError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace stereod
