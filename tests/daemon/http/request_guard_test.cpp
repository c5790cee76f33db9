// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/http/request_guard.h"

#include <gtest/gtest.h>

namespace stereod {
namespace {

TEST(RequestGuard, OtherHost_Refused) {
  EXPECT_TRUE(may_be_served({"127.0.0.1:8091", "", ""}, {}));
  EXPECT_TRUE(may_be_served({"localhost", "", "none"}, {}));
  EXPECT_TRUE(may_be_served({"localhost:8091", "http://localhost:8091", "same-origin"}, {}));
  for (const char* host :
       {"", "example.org", "example.org:8091", "127.0.0.1.example.org", "localhost.example.org:80",
        "127.0.0.1:80:evil", "127.0.0.2", "LOCALHOSTX", "[::ffff:127.0.0.1]"}) {
    EXPECT_FALSE(may_be_served({host, "", ""}, {})) << host;
  }
}

TEST(RequestGuard, OtherOrigin_Refused) {
  for (const char* origin : {"http://example.org", "null", "http://localhost", "https://localhost:8091",
                             "http://127.0.0.1:8091", "http://localhost:8092"}) {
    EXPECT_FALSE(may_be_served({"localhost:8091", origin, ""}, {})) << origin;
  }
  EXPECT_FALSE(may_be_served({"localhost:8091", "", "cross-site"}, {}));
  EXPECT_FALSE(may_be_served({"localhost:8091", "", "same-site"}, {}));
}

TEST(RequestGuard, AllowedHost_Served) {
  EXPECT_TRUE(may_be_served({"robot.lan:80", "http://robot.lan:80", "same-origin"}, {"robot.lan"}));
  EXPECT_FALSE(may_be_served({"robot.lan:80", "http://example.org", "cross-site"}, {"robot.lan"}));
  EXPECT_FALSE(may_be_served({"other.lan", "", ""}, {"robot.lan"}));
}

}  // namespace
}  // namespace stereod
