// SPDX-License-Identifier: BSD-3-Clause
// Turns SIGINT and SIGTERM into a question.
#pragma once

#include <signal.h>

namespace stereod {

/// Blocks SIGINT and SIGTERM, so that they do not end the program in the middle of something. Construct it before LCM
/// starts its threads, which inherit the mask.
class StopSignals {
 public:
  StopSignals();
  /// Returns whether one of the signals has arrived since the construction.
  bool arrived();

 private:
  sigset_t signals_{};
  bool arrived_ = false;
};

}  // namespace stereod
