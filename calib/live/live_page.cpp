#include "calib/live/live_page.h"

#include <httplib.h>

#include <chrono>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <thread>
#include <vector>

#include "calib/base/errors.h"
#include "calib/base/opencv_image.h"
#include "calib/live/live_page_text.h"

namespace stereod::calib {

struct LivePage::Server {
  httplib::Server http;
  int port = 0;
  std::mutex mutex;
  std::string state = "{}", left, right;  // JSON, JPEG, JPEG
  std::jthread thread;

  std::string locked_copy(const std::string& text) {
    const std::lock_guard lock(mutex);
    return text;
  }
};

namespace {

std::string jpeg(GrayView picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", as_opencv(picture), bytes, {cv::IMWRITE_JPEG_QUALITY, 80});
  return {bytes.begin(), bytes.end()};
}

bool is_this_machine(const std::string& host) {
  const std::string name = host.substr(0, host.rfind(':'));
  return name == "127.0.0.1" || name == "localhost";
}

}  // namespace

LivePage::LivePage(int port) : server_(std::make_unique<Server>()) {
  Server& s = *server_;
  s.http.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
    if (is_this_machine(request.get_header_value("Host"))) return httplib::Server::HandlerResponse::Unhandled;
    response.status = 403;
    return httplib::Server::HandlerResponse::Handled;
  });
  s.http.set_default_headers({{"Cache-Control", "no-store"}});
  s.http.Get("/", [](const httplib::Request&, httplib::Response& response) {
    response.set_content(kLivePage.data(), kLivePage.size(), "text/html; charset=utf-8");
  });
  s.http.Get("/state", [&s](const httplib::Request&, httplib::Response& response) {
    response.set_content(s.locked_copy(s.state), "application/json");
  });
  s.http.Get("/left.jpg", [&s](const httplib::Request&, httplib::Response& response) {
    response.set_content(s.locked_copy(s.left), "image/jpeg");
  });
  s.http.Get("/right.jpg", [&s](const httplib::Request&, httplib::Response& response) {
    response.set_content(s.locked_copy(s.right), "image/jpeg");
  });
  // Without its default options: another program may not share the port.
  s.http.set_socket_options([](int) {});
  s.port = port == 0                                ? s.http.bind_to_any_port("127.0.0.1")
           : s.http.bind_to_port("127.0.0.1", port) ? port
                                                    : -1;
  if (s.port < 0) {
    throw CalibrationError("the page's port " + std::to_string(port) +
                           " on 127.0.0.1 is taken; choose another with --port, or 0 for no page");
  }
  s.thread = std::jthread([&s] { s.http.listen_after_bind(); });
  // stop() would not be heard before that.
  while (!s.http.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

LivePage::~LivePage() {
  server_->http.stop();
  server_->thread.join();
}

int LivePage::port() const { return server_->port; }

void LivePage::show(const LiveSnapshot& snapshot, GrayView left, GrayView right) {
  std::string state = json_of(snapshot), left_jpeg = jpeg(left), right_jpeg = jpeg(right);
  const std::lock_guard lock(server_->mutex);
  server_->state = std::move(state);
  server_->left = std::move(left_jpeg);
  server_->right = std::move(right_jpeg);
}

}  // namespace stereod::calib
