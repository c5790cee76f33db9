// What the commands of stereo-tap share.
#pragma once

#include "daemon/base/stop_signals.h"

#include <filesystem>
#include <string>

namespace stereod {

/// Options that come before or after any command.
struct TapOptions {
  std::string lcm_url;  ///< empty: LCM's default
  std::string prefix = "STEREO";

  /// The channel of this daemon with that ending, for example STEREO_STATUS.
  std::string channel(const std::string& ending) const { return prefix + "_" + ending; }
};

/// What stereo-tap ends with.
enum ExitStatus : int {
  kAllWell = 0,
  kFailed = 1,  ///< wrong usage, no network, a file that cannot be written
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
  double timeout_s = 10;  ///< how long nothing may arrive
};
struct CheckOptions {
  double seconds = 5;
};
struct RecordOptions {
  std::filesystem::path file;
  double seconds = 0;  ///< 0: until a signal comes
};
struct PlayOptions {
  std::filesystem::path file;
  double speed = 1;        ///< > 0; 2 is twice as fast
  bool list_only = false;  ///< say what is in it, send nothing
};

/// The commands. Each returns an ExitStatus; they throw std::runtime_error with one sentence.
int run_status(const TapOptions& tap, const StatusOptions& options, StopSignals& stop);
int run_save(const TapOptions& tap, const SaveOptions& options, StopSignals& stop);
int run_check(const TapOptions& tap, const CheckOptions& options, StopSignals& stop);
int run_record(const TapOptions& tap, const RecordOptions& options, StopSignals& stop);
int run_play(const TapOptions& tap, const PlayOptions& options, StopSignals& stop);

/// One line on stderr, after the program's name.
void complain(const std::string& sentence);

}  // namespace stereod
