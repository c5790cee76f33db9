// SPDX-License-Identifier: BSD-3-Clause
// Defines the exception for command lines that make no sense.
#pragma once

#include <stdexcept>

namespace stereod {

/// Reports a command line that cannot be obeyed. what() names the option, the value found and the value allowed.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace stereod
