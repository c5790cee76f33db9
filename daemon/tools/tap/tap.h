// SPDX-License-Identifier: BSD-3-Clause
// Declarations that the commands of stereo-tap share.
#pragma once

#include "daemon/base/stop_signals.h"

#include <filesystem>
#include <string>

namespace stereod::tools {

/// Options of every command.
struct TapOptions {
  std::string lcm_url;  ///< empty: LCM's default
  std::string prefix = "STEREO";

  /// Returns a channel of this daemon, for example STEREO_STATUS for "STATUS".
  std::string channel(const std::string& suffix) const { return prefix + "_" + suffix; }
};

/// Exit status of stereo-tap.
enum ExitStatus : int {
  kSuccess = 0,
  kFailed = 1,  ///< wrong usage, no network, or a file that cannot be written
  kNothingArrived = 2,
  kSomethingLost = 3,
};

struct StatusOptions {
  bool once = false;
  double timeout_s = 5;
};
struct SaveOptions {
  int frames = 1;
  std::filesystem::path directory;
  double timeout_s = 10;  ///< without a complete frame
};
struct CheckOptions {
  double seconds = 5;
};
struct RecordOptions {
  std::filesystem::path file;
  double seconds = 0;  ///< 0: until a signal arrives
};
struct PlayOptions {
  std::filesystem::path file;
  double speed = 1;        ///< factor > 0; 2: twice as fast
  bool list_only = false;  ///< print the content, publish nothing
};

/// Run a command until it is done or @p stop has arrived. Return an ExitStatus. Throw std::runtime_error.
int run_status(const TapOptions& tap, const StatusOptions& options, StopSignals& stop);
int run_save(const TapOptions& tap, const SaveOptions& options, StopSignals& stop);
int run_check(const TapOptions& tap, const CheckOptions& options, StopSignals& stop);
int run_record(const TapOptions& tap, const RecordOptions& options, StopSignals& stop);
int run_play(const TapOptions& tap, const PlayOptions& options, StopSignals& stop);

/// Prints the program's name and @p message to stderr.
void print_error(const std::string& message);

}  // namespace stereod::tools
