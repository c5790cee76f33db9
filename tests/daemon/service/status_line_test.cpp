#include "daemon/service/status_line.h"

#include <gtest/gtest.h>

namespace stereod {
namespace {

status_t status(const char* state, const char* reason, double fps = 0, double latency_ms = 0) {
  status_t made{};
  made.state = state;
  made.reason = reason;
  made.fps_out = fps;
  made.latency_ms_median = latency_ms;
  return made;
}

TEST(StatusLine, ReadsLikeASentence) {
  EXPECT_EQ(status_line(status("starting", "waiting for the first frames")),
            "Starting: waiting for the first frames.");
  EXPECT_EQ(status_line(status("streaming", "", 29.94, 11.7)),
            "Streaming: 29.9 frames a second, 12 ms from exposure to the last row.");
  EXPECT_EQ(
      status_line(status("degraded", "the network refused messages", 30, 9)),
      "Degraded: 30.0 frames a second, 9 ms from exposure to the last row; the network refused messages.");
  EXPECT_EQ(status_line(status("waiting_for_cameras", "no frames from either camera")),
            "Waiting for cameras: no frames from either camera.");
}

}  // namespace
}  // namespace stereod
