// SPDX-License-Identifier: BSD-3-Clause
// Prints the nearest point of each frame [m].
//   example_nearest_point FRAMES [PREFIX]
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "daemon/client/stereod_client.h"

int main(int argc, char** argv) {
  int frames = argc > 1 ? std::atoi(argv[1]) : 10;
  stereod::StereoClient::Options options;
  if (argc > 2) options.prefix = argv[2];
  try {
    stereod::StereoClient client(options);
    client.on_frame([&](stereod::StereoFrame&& frame) {
      if (!frame.camera || !frame.complete()) return;  // no camera_info yet, or rows were lost
      stereod::StereoPoint nearest{0, 0, 1e9F};
      for (const stereod::StereoPoint& point : frame.points(2)) {
        if (point.z < nearest.z) nearest = point;
      }
      std::printf("frame %lld: nearest at x %.3f y %.3f z %.3f m\n", static_cast<long long>(frame.frame),
                  static_cast<double>(nearest.x), static_cast<double>(nearest.y),
                  static_cast<double>(nearest.z));
      std::fflush(stdout);
      --frames;
    });
    while (frames > 0) client.handle(1000);
    std::fputs(stereod::describe_problems(client.counts()).c_str(), stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
