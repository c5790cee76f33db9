// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/http/local_server.h"

#include <httplib.h>

#include <chrono>
#include <thread>
#include <utility>

#include "daemon/http/request_guard.h"

namespace stereod {
namespace {

constexpr const char* kAddress = "127.0.0.1";
constexpr int kThreads = 32;         // each serves one client
constexpr int kClientTimeout_s = 3;  // of a client that neither sends nor reads
constexpr std::size_t kMaxRequest = 4096;
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' blob:; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

using HandlerResponse = httplib::Server::HandlerResponse;

HandlerResponse refuse(httplib::Response& response, int status, const char* text) {
  response.status = status;
  response.set_content(text, "text/plain");
  return HandlerResponse::Handled;
}

HandlerResponse check_request(const httplib::Request& request, httplib::Response& response,
                              const std::vector<std::string>& allowed_hosts) {
  const RequestOrigin origin{request.get_header_value("Host"), request.get_header_value("Origin"),
                             request.get_header_value("Sec-Fetch-Site")};
  if (!may_be_served(origin, allowed_hosts)) return refuse(response, 403, "host or origin not allowed\n");
  // The library does not check whether a range lies inside the content.
  if (request.has_header("Range")) return refuse(response, 416, "ranges are not served\n");
  return HandlerResponse::Unhandled;
}

void set_limits(httplib::Server& http) {
  http.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  http.set_payload_max_length(kMaxRequest);
  http.set_read_timeout(kClientTimeout_s);
  http.set_write_timeout(kClientTimeout_s);
  http.set_keep_alive_timeout(kClientTimeout_s);
  // The library's default options let another program share the port. SO_REUSEADDR only frees a port that was just closed.
  http.set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
}

}  // namespace

struct LocalServer::Impl {
  LocalServerOptions options;
  httplib::Server http;
  int port = -1;
  std::thread thread;
};

LocalServer::LocalServer(LocalServerOptions options) : impl_(new Impl{std::move(options), {}, -1, {}}) {
  httplib::Server& http = impl_->http;
  set_limits(http);
  http.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    return check_request(request, response, impl_->options.allowed_hosts);
  });
  http.set_default_headers({{"Cache-Control", "no-store"},
                            {"Content-Security-Policy", kContentSecurityPolicy},
                            {"Cross-Origin-Resource-Policy", "same-origin"},
                            {"X-Content-Type-Options", "nosniff"}});
}

LocalServer::~LocalServer() {
  impl_->http.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
}

void LocalServer::get(const std::string& path, Handler handler) { impl_->http.Get(path, std::move(handler)); }

void LocalServer::get_text(const std::string& path, std::string_view text, const std::string& content_type) {
  get(path, [text, content_type](const httplib::Request&, httplib::Response& response) {
    response.set_content(text.data(), text.size(), content_type);
  });
}

void LocalServer::start() {
  const int wanted = impl_->options.port;
  if (wanted == 0) {
    impl_->port = impl_->http.bind_to_any_port(kAddress);
  } else if (impl_->http.bind_to_port(kAddress, wanted)) {
    impl_->port = wanted;
  }
  if (impl_->port < 0) {
    throw PortTakenError("port " + std::to_string(wanted) + " on " + kAddress +
                         " is taken; choose another with --port");
  }
  impl_->thread = std::thread([this] { impl_->http.listen_after_bind(); });
  // stop() has no effect before the server runs.
  while (!impl_->http.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

int LocalServer::port() const { return impl_->port; }

}  // namespace stereod
