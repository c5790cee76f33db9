// SPDX-License-Identifier: BSD-3-Clause
#include "calib/live/live_page.h"

#include <httplib.h>

#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "calib/base/errors.h"
#include "calib/base/opencv_image.h"
#include "calib/live/live_page_text.h"
#include "daemon/http/local_server.h"

namespace stereod::calib {
namespace {

std::string encode_jpeg(GrayView image) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", as_opencv(image), bytes, {cv::IMWRITE_JPEG_QUALITY, 80});
  return {bytes.begin(), bytes.end()};
}

}  // namespace

struct LivePage::Impl {
  std::mutex mutex;
  std::string state = "{}", left, right;  // JSON, JPEG, JPEG
  LocalServer server;                     // the last member: its threads use the others

  void serve(const std::string& path, const std::string Impl::*content, const std::string& content_type) {
    server.get(path, [this, content, content_type](const httplib::Request&, httplib::Response& response) {
      const std::lock_guard lock(mutex);
      response.set_content(this->*content, content_type);
    });
  }
};

LivePage::LivePage(int port)
    : impl_(new Impl{.mutex = {}, .left = {}, .right = {}, .server = LocalServer({port, {}})}) {
  LocalServer& server = impl_->server;
  server.get_text("/", kLivePageHtml, "text/html; charset=utf-8");
  server.get_text("/live.css", kLivePageCss, "text/css; charset=utf-8");
  server.get_text("/live.js", kLivePageJs, "text/javascript; charset=utf-8");
  impl_->serve("/state", &Impl::state, "application/json");
  impl_->serve("/left.jpg", &Impl::left, "image/jpeg");
  impl_->serve("/right.jpg", &Impl::right, "image/jpeg");
  try {
    server.start();
  } catch (const PortTakenError& error) {
    throw CalibrationError("live page: " + std::string(error.what()) + ", or 0 for no page");
  }
}

LivePage::~LivePage() = default;

int LivePage::port() const { return impl_->server.port(); }

void LivePage::show(const LiveSnapshot& snapshot, GrayView left, GrayView right) {
  std::string state = json_of(snapshot), left_jpeg = encode_jpeg(left), right_jpeg = encode_jpeg(right);
  const std::lock_guard lock(impl_->mutex);
  impl_->state = std::move(state);
  impl_->left = std::move(left_jpeg);
  impl_->right = std::move(right_jpeg);
}

}  // namespace stereod::calib
