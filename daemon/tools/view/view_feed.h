// From LCM to the live view.
#pragma once

#include <string>

#include "daemon/lcm/receiver.h"
#include "daemon/tools/view/live_view.h"

namespace stereod {

/// Subscribes to one daemon.
class ViewFeed {
 public:
  /// `view` outlives it. Throws BusError or std::runtime_error with a sentence.
  ViewFeed(const std::string& lcm_url, const std::string& prefix, LiveView& view);

  /// Handles what has come, for about 20 ms.
  void run_once();

 private:
  void take_others();

  LcmReceiver others_;  // opened first: its complaints are the better ones
  StereoClient frames_;
};

}  // namespace stereod
