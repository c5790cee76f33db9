// A live session as a page on this machine.
#pragma once

#include <memory>
#include <string>

#include "calib/live/live_state.h"
#include "core/base/image.h"

namespace stereod::calib {

/// Serves on 127.0.0.1 only, and only to who asks for this machine by that name, so that no other page in the
/// browser can look through the cameras. Over ssh: ssh -L 8090:127.0.0.1:8090 robot.
class LivePage {
 public:
  /// `port` 0: any free one. Throws CalibrationError if the port is taken.
  explicit LivePage(int port);
  ~LivePage();
  LivePage(const LivePage&) = delete;
  LivePage& operator=(const LivePage&) = delete;

  int port() const;
  void show(const LiveSnapshot& snapshot, GrayView left, GrayView right);

 private:
  struct Server;
  std::unique_ptr<Server> server_;
};

}  // namespace stereod::calib
