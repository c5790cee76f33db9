// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/view/view_server.h"

#include <httplib.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <mutex>

#include "daemon/http/local_server.h"
#include "daemon/tools/view/page_files.h"
#include "daemon/tools/view/palette_module.h"
#include "daemon/tools/view/snapshot_codec.h"

namespace stereod::tools {
namespace {

constexpr std::chrono::milliseconds kMaxWait{1000};  // for a new snapshot
constexpr int kMaxStep = 8;

/// Returns a number of the query; @p default_value if it is missing, −1 if it is not a number.
std::int64_t query_number(const httplib::Request& request, const char* name, std::int64_t default_value) {
  if (!request.has_param(name)) return default_value;
  const std::string text = request.get_param_value(name);
  char* end = nullptr;
  const long long value = std::strtoll(text.c_str(), &end, 10);
  return !text.empty() && *end == '\0' ? value : -1;
}

using Bytes = std::shared_ptr<const std::string>;

void send_bytes(const Bytes& bytes, httplib::Response& response) {
  response.set_content_provider(bytes->size(), "application/octet-stream",
                                [bytes](std::size_t offset, std::size_t size, httplib::DataSink& sink) {
                                  offset = std::min(offset, bytes->size());
                                  const std::size_t rest = bytes->size() - offset;
                                  return sink.write(bytes->data() + offset, std::min(size, rest));
                                });
}

}  // namespace

struct ViewServer::Impl {
  struct Encoded {
    std::int64_t number = 0;
    Bytes bytes;
  };

  const LiveView& view;
  const std::string palette = palette_module();
  std::mutex mutex;
  std::map<int, Encoded> encoded;  // the latest snapshot, by step
  LocalServer server;              // the last member: its threads use the others

  /// Encodes a snapshot once for all clients.
  Bytes encode_once(const Snapshot& snapshot, int step) {
    const std::lock_guard lock(mutex);
    auto& [number, bytes] = encoded[step];
    if (!bytes || number != snapshot.number) {
      number = snapshot.number;
      bytes = std::make_shared<const std::string>(encode_snapshot(snapshot, step));
    }
    return bytes;
  }

  void answer_snapshot(const httplib::Request& request, httplib::Response& response) {
    const std::int64_t after = query_number(request, "after", 0), step = query_number(request, "step", 1);
    if (after < 0 || step < 1 || step > kMaxStep) {
      response.status = 400;
      response.set_content("after must be a number ≥ 0, step 1…8\n", "text/plain; charset=utf-8");
      return;
    }
    const auto snapshot = view.wait_newer(after, kMaxWait);
    const std::int64_t newest = snapshot ? snapshot->number : 0;
    if (newest > after) return send_bytes(encode_once(*snapshot, static_cast<int>(step)), response);
    // 205: the page knows a number that this server has not reached, so the server was restarted.
    response.status = newest < after ? 205 : 204;
  }
};

ViewServer::ViewServer(const LiveView& view, const ViewServerOptions& options)
    : impl_(new Impl{.view = view,
                     .mutex = {},
                     .encoded = {},
                     .server = LocalServer({options.port, options.allowed_hosts})}) {
  LocalServer& server = impl_->server;
  for (const PageFile& file : kPageFiles) {
    server.get_text(file.path, file.text, file.content_type);
  }
  server.get_text("/palette.js", impl_->palette, "text/javascript; charset=utf-8");
  server.get("/snapshot", [this](const httplib::Request& request, httplib::Response& response) {
    impl_->answer_snapshot(request, response);
  });
  server.start();
}

ViewServer::~ViewServer() = default;

int ViewServer::port() const { return impl_->server.port(); }

}  // namespace stereod::tools
