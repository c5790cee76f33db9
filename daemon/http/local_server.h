// SPDX-License-Identifier: BSD-3-Clause
// The HTTP server of every page that a program shows on this machine.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace httplib {
struct Request;
struct Response;
}  // namespace httplib

namespace stereod {

struct LocalServerOptions {
  int port = 0;                            ///< 0: any free port
  std::vector<std::string> allowed_hosts;  ///< accepted in Host besides 127.0.0.1 and localhost
};

/// The port is in use by another program.
class PortTakenError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Serves HTTP on 127.0.0.1. The only owner of an httplib::Server, so that every page has the same protection:
///
/// * a request must pass may_be_served(), else 403; a request for a range gets 416;
/// * at most 32 clients at once, 4096 bytes a request, 3 s for a client that neither sends nor reads;
/// * pages load scripts, styles and data only from this server and cannot be framed (Content-Security-Policy, without
///   inline scripts and styles); answers are not cached.
///
/// From another machine: ssh -L PORT:127.0.0.1:PORT ROBOT.
class LocalServer {
 public:
  using Handler = std::function<void(const httplib::Request&, httplib::Response&)>;

  explicit LocalServer(LocalServerOptions options);
  /// Stops and waits for the handlers that run.
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  /// Answers GET @p path with @p handler, which runs in several threads at once. Call before start().
  void get(const std::string& path, Handler handler);
  /// Answers GET @p path with @p text, which must outlive the server. Call before start().
  void get_text(const std::string& path, std::string_view text, const std::string& content_type);

  /// Binds the port and starts serving. Throws PortTakenError.
  void start();

  int port() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stereod
