// SPDX-License-Identifier: BSD-3-Clause
// Exceptions that end a run of stereo-calibrate, and its exit statuses.
#pragma once

#include <stdexcept>

#include "daemon/base/usage_error.h"

namespace stereod::calib {

/// Reports images that a calibration cannot be computed from or checked with. what() is one sentence that
/// ends with what to do.
class CalibrationError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline constexpr int kExitGood = 0;
inline constexpr int kExitBadResult = 1;  ///< the run completed, but its result should not be used
inline constexpr int kExitBadInput = 2;   ///< nothing was done: the command line or a file is invalid
inline constexpr int kExitFailure = 3;    ///< the machine failed, not the input

}  // namespace stereod::calib
