// SPDX-License-Identifier: BSD-3-Clause
// Serves the page of stereo-view.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/tools/view/live_view.h"

namespace stereod::tools {

struct ViewServerOptions {
  int port = 8091;                         ///< 0: any free port
  std::vector<std::string> allowed_hosts;  ///< as in LocalServerOptions
};

/// Serves the page and the snapshots of a LiveView on 127.0.0.1, with the protection of LocalServer.
class ViewServer {
 public:
  /// Starts serving. @p view must outlive the server. Throws PortTakenError.
  ViewServer(const LiveView& view, const ViewServerOptions& options);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  int port() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stereod::tools
