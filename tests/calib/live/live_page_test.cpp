// SPDX-License-Identifier: BSD-3-Clause
#include "calib/live/live_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include "calib/base/errors.h"

namespace stereod::calib {
namespace {

using testing::HasSubstr;

TEST(LivePage, Snapshot_ServedToThisMachineOnly) {
  LivePage page(0);
  httplib::Client client("127.0.0.1", page.port());
  EXPECT_EQ(client.Get("/state")->body, "{}");
  LiveSnapshot snapshot;
  snapshot.image = {64, 48};
  snapshot.words = "hold still";
  snapshot.taken = 3, snapshot.wanted = 15;
  const GrayImage image(64, 48);
  page.show(snapshot, image.view(), image.view());
  EXPECT_THAT(client.Get("/state")->body, HasSubstr("\"words\":\"hold still\",\"taken\":3"));
  EXPECT_EQ(client.Get("/left.jpg")->body.substr(0, 2), "\xff\xd8");
  EXPECT_EQ(client.Get("/right.jpg")->get_header_value("Content-Type"), "image/jpeg");
  EXPECT_THAT(client.Get("/")->body, HasSubstr("<title>Calibrating</title>"));
  EXPECT_EQ(client.Get("/etc/passwd")->status, 404);
  // A page of another name that leads here (DNS rebinding), and a page of another origin.
  EXPECT_EQ(client.Get("/left.jpg", {{"Origin", "http://example.org"}})->status, 403);
  EXPECT_EQ(client.Get("/live.js")->status, 200);
  EXPECT_THAT(client.Get("/")->get_header_value("Content-Security-Policy"), HasSubstr("default-src 'none'"));
  EXPECT_EQ(client.Get("/left.jpg", {{"Host", "example.org"}})->status, 403);
  EXPECT_EQ(client.Get("/left.jpg", {{"Host", "localhost:80"}})->status, 200);
}

TEST(LivePage, PortTaken_Throws) {
  LivePage page(0);
  try {
    LivePage second(page.port());
    FAIL() << "two pages on one port";
  } catch (const CalibrationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is taken; choose another with --port"));
  }
}

}  // namespace
}  // namespace stereod::calib
