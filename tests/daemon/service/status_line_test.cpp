// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/status_line.h"

#include <gtest/gtest.h>

namespace stereod {
namespace {

std::string line(ServiceState state, const char* reason, double fps = 0, double latency_ms = 0) {
  status_t status{};
  status.reason = reason;
  status.fps_out = fps;
  status.latency_ms_median = latency_ms;
  return status_line(state, status);
}

TEST(StatusLine, EachState_OneLine) {
  EXPECT_EQ(line(ServiceState::kStarting, "waiting for the first frames"),
            "starting: waiting for the first frames");
  EXPECT_EQ(line(ServiceState::kStreaming, "", 29.94, 11.7), "streaming: 29.9 fps, latency 12 ms");
  EXPECT_EQ(line(ServiceState::kDegraded, "the network refused messages", 30, 9),
            "degraded: 30.0 fps, latency 9 ms; the network refused messages");
  EXPECT_EQ(line(ServiceState::kWaitingForCameras, "no frames from either camera"),
            "waiting for cameras: no frames from either camera");
}

}  // namespace
}  // namespace stereod
