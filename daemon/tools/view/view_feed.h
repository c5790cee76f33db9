// SPDX-License-Identifier: BSD-3-Clause
// Feeds what arrives over LCM to the live view.
#pragma once

#include <string>

#include "daemon/lcm/receiver.h"
#include "daemon/tools/view/live_view.h"

namespace stereod::tools {

/// Subscribes to one daemon.
class ViewFeed {
 public:
  /// @p view must outlive the feed. Throws BusError or std::runtime_error.
  ViewFeed(const std::string& lcm_url, const std::string& prefix, LiveView& view);

  /// Handles messages for about 20 ms.
  void run_once();

 private:
  void receive_others();

  LcmReceiver others_;  // status, scan, left image; the first member, because its errors name the remedy
  StereoClient frames_;
};

}  // namespace stereod::tools
