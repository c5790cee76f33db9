#include "daemon/tools/view/view_server.h"

#include <httplib.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "daemon/tools/view/page_text.h"
#include "daemon/tools/view/request_guard.h"

namespace stereod {
namespace {

constexpr int kThreads = 32;       // each waits for one client
constexpr int kClientTimeout = 3;  // s, for a client that sends or takes nothing
constexpr std::size_t kMaxRequest = 4096;
constexpr std::chrono::milliseconds kPatience{1000};  // how long a request waits for something new
constexpr int kMaxStep = 8;
constexpr std::string_view kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' blob:; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

std::int64_t number_of(const httplib::Request& request, const char* name, std::int64_t otherwise) {
  if (!request.has_param(name)) return otherwise;
  const std::string text = request.get_param_value(name);
  char* end = nullptr;
  const long long value = std::strtoll(text.c_str(), &end, 10);
  return !text.empty() && *end == '\0' ? value : -1;
}

}  // namespace

struct ViewServer::Server {
  const LiveView& view;
  httplib::Server http;
  int port = -1;
  std::mutex mutex;
  std::map<int, std::pair<std::int64_t, std::shared_ptr<const std::string>>>
      encoded;  // by step: number, bytes
  std::jthread thread;

  /// Encoded once, however many clients ask for it.
  std::shared_ptr<const std::string> encoded_once(const Snapshot& snapshot, int step) {
    const std::lock_guard lock(mutex);
    auto& [number, bytes] = encoded[step];
    if (!bytes || number != snapshot.number) {
      number = snapshot.number;
      bytes = std::make_shared<const std::string>(encoded_moment(snapshot, step));
    }
    return bytes;
  }

  void answer_moment(const httplib::Request& request, httplib::Response& response) {
    const std::int64_t after = number_of(request, "after", 0), step = number_of(request, "step", 1);
    if (after < 0 || step < 1 || step > kMaxStep) {
      response.status = 400;
      response.set_content("after is a number, step is 1 to 8\n", "text/plain");
      return;
    }
    const auto snapshot = view.wait_newer(after, kPatience);
    if (!snapshot || snapshot->number <= after) {
      // 205: the page has seen more than there was, so this server began anew; so does the page.
      response.status = (snapshot ? snapshot->number : 0) < after ? 205 : 204;
      return;
    }
    const auto bytes = encoded_once(*snapshot, static_cast<int>(step));
    response.set_content_provider(bytes->size(), "application/octet-stream",
                                  [bytes](std::size_t at, std::size_t size, httplib::DataSink& sink) {
                                    at = std::min(at, bytes->size());
                                    return sink.write(bytes->data() + at, std::min(size, bytes->size() - at));
                                  });
  }
};

namespace {

void serve_text(httplib::Server& http, const char* path, std::string_view text, const char* type) {
  http.Get(path, [text, type](const httplib::Request&, httplib::Response& response) {
    response.set_content(text.data(), text.size(), type);
  });
}

void set_limits(httplib::Server& http) {
  http.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  http.set_payload_max_length(kMaxRequest);
  http.set_read_timeout(kClientTimeout);
  http.set_write_timeout(kClientTimeout);
  http.set_keep_alive_timeout(kClientTimeout);
  // Not its default options, by which another program could share the port; but a port that was just closed
  // is free.
  http.set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
}

}  // namespace

ViewServer::ViewServer(const LiveView& view, const ViewServerOptions& options)
    : server_(new Server{.view = view, .http = {}, .mutex = {}, .encoded = {}, .thread = {}}) {
  Server& s = *server_;
  set_limits(s.http);
  s.http.set_pre_routing_handler([allowed = options.allowed_hosts](const auto& request, auto& response) {
    const RequestOrigin origin{request.get_header_value("Host"), request.get_header_value("Origin"),
                               request.get_header_value("Sec-Fetch-Site")};
    if (!may_be_served(origin, allowed)) {
      response.status = 403;
      response.set_content("not for this host or origin; see stereo-view --help\n", "text/plain");
    } else if (request.has_header("Range")) {  // the library does not ask whether there is as much
      response.status = 416;
      response.set_content("parts are not served\n", "text/plain");
    } else {
      return httplib::Server::HandlerResponse::Unhandled;
    }
    return httplib::Server::HandlerResponse::Handled;
  });
  s.http.set_default_headers({{"Cache-Control", "no-store"},
                              {"Content-Security-Policy", std::string(kPolicy)},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"X-Content-Type-Options", "nosniff"}});
  serve_text(s.http, "/", kPageHtml, "text/html; charset=utf-8");
  serve_text(s.http, "/view.css", kPageCss, "text/css; charset=utf-8");
  serve_text(s.http, "/view.js", kPageJs, "text/javascript; charset=utf-8");
  serve_text(s.http, "/cloud.js", kCloudJs, "text/javascript; charset=utf-8");
  serve_text(s.http, "/charts.js", kChartsJs, "text/javascript; charset=utf-8");
  s.http.Get("/moment", [&s](const httplib::Request& request, httplib::Response& response) {
    s.answer_moment(request, response);
  });
  s.port = options.port == 0                                ? s.http.bind_to_any_port("127.0.0.1")
           : s.http.bind_to_port("127.0.0.1", options.port) ? options.port
                                                            : -1;
  if (s.port < 0) {
    throw std::runtime_error("port " + std::to_string(options.port) +
                             " on 127.0.0.1 is taken; choose another with --port.");
  }
  s.thread = std::jthread([&s] { s.http.listen_after_bind(); });
  // stop() would not be heard before that.
  while (!s.http.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

ViewServer::~ViewServer() {
  server_->http.stop();
  server_->thread.join();
}

int ViewServer::port() const { return server_->port; }

}  // namespace stereod
