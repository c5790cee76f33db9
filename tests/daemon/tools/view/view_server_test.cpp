// SPDX-License-Identifier: BSD-3-Clause
// The server of the page and its clients, well-behaved and hostile.
#include "daemon/tools/view/view_server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/tools/view/snapshot_codec.h"
#include "tests/support/frame_messages.h"
#include "tests/support/random_images.h"

namespace stereod::tools {
namespace {

using testing::HasSubstr;

class StereoView : public testing::Test {
 protected:
  StereoView() {
    StereoFrame frame;
    frame.disparity = DisparityMap(64, 48);
    view_.take(std::move(frame), {});
  }

  httplib::Client client() { return httplib::Client("127.0.0.1", server_->port()); }

  LiveView view_;
  std::unique_ptr<ViewServer> server_ =
      std::make_unique<ViewServer>(view_, ViewServerOptions{0, {"robot.lan"}});
};

TEST_F(StereoView, Page_Served) {
  httplib::Client web = client();
  EXPECT_THAT(web.Get("/")->body, HasSubstr("<title>stereo-view</title>"));
  EXPECT_THAT(web.Get("/")->get_header_value("Content-Security-Policy"), HasSubstr("default-src 'none'"));
  EXPECT_EQ(web.Get("/view.js")->status, 200);
  EXPECT_EQ(web.Get("/cloud.js")->status, 200);
  EXPECT_EQ(web.Get("/charts.js")->status, 200);
  EXPECT_THAT(web.Get("/palette.js")->body, HasSubstr("export const palette = [[0,47,119],"));
  EXPECT_THAT(web.Get("/view.css")->get_header_value("Content-Type"), HasSubstr("text/css"));
  const auto snapshot = web.Get("/snapshot?after=0&step=2");
  EXPECT_EQ(snapshot->status, 200);
  EXPECT_EQ(snapshot->body, encode_snapshot(*view_.wait_newer(0, std::chrono::milliseconds(0)), 2));
  EXPECT_EQ(web.Get("/snapshot?after=1")->status, 204);     // no newer snapshot
  EXPECT_EQ(web.Get("/snapshot?after=5000")->status, 205);  // the number is of an earlier server
  for (const char* range :
       {"bytes=0-1000000", "bytes=900000-900100", "bytes=100-99999999999", "bytes=0-10"}) {
    const auto part = web.Get("/snapshot", {{"Range", range}});
    ASSERT_TRUE(part) << range;
    EXPECT_EQ(part->status, 416) << range;
    EXPECT_LT(part->body.size(), 100U) << range;
    EXPECT_EQ(web.Get("/view.css", {{"Range", range}})->status, 416) << range;
  }
  EXPECT_EQ(web.Get("/etc/passwd")->status, 404);
  EXPECT_EQ(web.Get("/../view.js")->status, 404);
  EXPECT_EQ(web.Post("/snapshot", "x", "text/plain")->status, 404);
}

TEST_F(StereoView, Page_LoadsNothingFromTheNetwork) {
  httplib::Client web = client();
  for (const char* part :
       {"/", "/view.css", "/charts.js", "/cloud.js", "/geometry.js", "/images.js", "/palette.js",
        "/points.js", "/save.js", "/snapshot.js", "/status.js", "/view.js"}) {
    ASSERT_EQ(web.Get(part)->status, 200) << part;
    const std::string text = web.Get(part)->body;
    EXPECT_EQ(text.find("http://"), std::string::npos) << part;
    EXPECT_EQ(text.find("https://"), std::string::npos) << part;
  }
}

TEST_F(StereoView, OtherHostOrOrigin_Refused) {
  httplib::Client web = client();
  for (const char* path : {"/", "/view.js", "/snapshot"}) {
    EXPECT_EQ(web.Get(path, {{"Host", "example.org"}})->status, 403) << path;
    EXPECT_EQ(web.Get(path, {{"Origin", "http://example.org"}})->status, 403) << path;
    EXPECT_EQ(web.Get(path, {{"Sec-Fetch-Site", "cross-site"}})->status, 403) << path;
    EXPECT_EQ(web.Get(path, {{"Host", "robot.lan"}})->status, 200) << path;
  }
}

TEST_F(StereoView, InvalidQuery_Refused) {
  httplib::Client web = client();
  for (const char* query :
       {"after=-1", "after=x", "after=", "step=0", "step=9", "step=1e9", "after=1;step"}) {
    EXPECT_EQ(web.Get("/snapshot?" + std::string(query))->status, 400) << query;
  }
  // A number that this server never reached.
  EXPECT_EQ(web.Get("/snapshot?after=99999999999999999999")->status, 205);
}

TEST_F(StereoView, PortTaken_Throws) {
  try {
    const ViewServer second(view_, {server_->port(), {}});
    FAIL() << "two pages on one port";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("is taken; choose another with --port"));
  }
}

/// A connection that sends any bytes.
class RawClient {
 public:
  explicit RawClient(int port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    EXPECT_EQ(connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  RawClient(RawClient&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  RawClient& operator=(RawClient&&) = delete;
  ~RawClient() {
    if (fd_ >= 0) close(fd_);
  }
  void send(const std::string& text) const { ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL); }

 private:
  int fd_;
};

TEST_F(StereoView, SlowAndMalformedClients_StillServes) {
  Random random(9);
  std::vector<RawClient> clients;
  for (int i = 0; i < 60; ++i) {
    RawClient& raw = clients.emplace_back(server_->port());
    switch (i % 6) {
      case 0:  // sends nothing
        break;
      case 1:
        raw.send("GET /snapshot HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ");  // an unfinished request
        break;
      case 2: {
        std::string rubbish;
        for (int k = 0; k < 2000; ++k) rubbish += static_cast<char>(random.between(0, 255));
        raw.send(rubbish);
        break;
      }
      case 3:
        raw.send("GET /" + std::string(100'000, 'a') + " HTTP/1.1\r\n\r\n");
        break;
      case 4:
        raw.send("POST /snapshot HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999999\r\n\r\nx");
        break;
      default:  // never reads the answers
        for (int k = 0; k < 20; ++k) raw.send("GET /view.js HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    }
  }
  httplib::Client web = client();
  web.set_read_timeout(60);
  const auto answer = web.Get("/snapshot");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  clients.clear();
  EXPECT_EQ(client().Get("/")->status, 200);
}

}  // namespace
}  // namespace stereod::tools
