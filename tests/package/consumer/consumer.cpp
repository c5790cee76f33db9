// SPDX-License-Identifier: BSD-3-Clause
// Receives three complete frames. Exit status 0, or 1 after 20 s without them.
#include <stereod/stereod_client.h>
#include <stereod/frame_t.hpp>

#include <chrono>
#include <cstdio>

int main() {
  int frames = 0;
  stereod::StereoClient client{stereod::StereoClient::Options{}};
  client.on_frame([&](stereod::StereoFrame&& frame) {
    if (!frame.complete()) return;
    const stereod::frame_t& summary = *frame.summary;
    std::printf("frame %lld with %d rows\n", static_cast<long long>(summary.frame), summary.rows);
    ++frames;
  });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (frames < 3 && std::chrono::steady_clock::now() < deadline) client.handle(100);
  return frames < 3 ? 1 : 0;
}
