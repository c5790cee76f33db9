// SIGINT and SIGTERM as a question instead of an interruption.
#pragma once

#include <signal.h>

namespace stereod {

/// Keeps SIGINT and SIGTERM from ending the program in the middle of something: from its construction on they
/// are only noted. Make it before LCM starts its threads, which inherit this.
class StopSignals {
 public:
  StopSignals();
  /// True once one of them has come.
  bool arrived();

 private:
  sigset_t signals_{};
  bool arrived_ = false;
};

}  // namespace stereod
