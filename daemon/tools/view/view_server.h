// The page on this machine.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/tools/view/live_view.h"

namespace stereod {

struct ViewServerOptions {
  int port = 8091;  ///< 0: any free one
  std::vector<std::string>
      allowed_hosts;  ///< names by which the page may be asked for, besides this machine's
};

/// Serves on 127.0.0.1 only, and only what may_be_served(). Over ssh: ssh -L 8091:127.0.0.1:8091 robot.
class ViewServer {
 public:
  /// `view` outlives it. Throws std::runtime_error if the port is taken.
  ViewServer(const LiveView& view, const ViewServerOptions& options);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  int port() const;

 private:
  struct Server;
  std::unique_ptr<Server> server_;
};

}  // namespace stereod
