// SPDX-License-Identifier: BSD-3-Clause
// A live session as a page on this machine.
#pragma once

#include <memory>

#include "calib/live/live_state.h"
#include "core/base/image.h"

namespace stereod::calib {

/// Serves the page on 127.0.0.1 with the protection of LocalServer. Over ssh: ssh -L 8090:127.0.0.1:8090 ROBOT.
class LivePage {
 public:
  /// Starts serving. @p port 0: any free port. Throws CalibrationError if the port is taken.
  explicit LivePage(int port);
  ~LivePage();
  LivePage(const LivePage&) = delete;
  LivePage& operator=(const LivePage&) = delete;

  int port() const;
  /// Replaces what the page shows.
  void show(const LiveSnapshot& snapshot, GrayView left, GrayView right);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stereod::calib
