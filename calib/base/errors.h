// What ends a run of stereo-calibrate, and the status it ends with.
#pragma once

#include <stdexcept>

#include "daemon/base/usage_error.h"

namespace stereod {

/// Images that cannot be calibrated or checked with; what() is one sentence that says what to do.
class CalibrationError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline constexpr int kExitGood = 0;
inline constexpr int kExitBadResult = 1;  ///< done, but the result should not be used
inline constexpr int kExitBadInput = 2;   ///< nothing was done: the command line or a file is wrong
inline constexpr int kExitFailure = 3;    ///< the machine failed, not the input

}  // namespace stereod
