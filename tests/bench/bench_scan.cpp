// SPDX-License-Identifier: BSD-3-Clause
// What the obstacle scan costs beside the matching it follows: times of one thread on the rendered scene, in
// turn, the minimum of many.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "core/perception/ground_plane.h"
#include "tests/support/floor_world.h"
#include "tests/support/scene_matcher.h"

namespace stereod {
namespace {

template <typename Work>
void keep_least(double& least_ms, const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  least_ms = std::min(least_ms, took.count());
}

int run() {
  const SyntheticScene scene;
  SceneMatcher matcher(scene, 1);
  ObstacleScan scan({}, matcher.camera(), {0.45, 0});
  GroundFit fit(matcher.camera());
  double match_ms = 1e9, scan_ms = 1e9, fit_ms = 1e9;
  for (int round = 0; round < 200; ++round) {
    matcher.load(round % scene.frames());
    keep_least(match_ms, [&] { matcher.rematch(); });
    const DisparityImage& disparity = matcher.disparity();
    keep_least(scan_ms, [&] { scan_of(scan, disparity); });
    keep_least(fit_ms, [&] {
      for (int y = 0; y < disparity.height(); ++y) fit.add_row(y, disparity.row(y));
      fit.finish();
    });
  }
  std::printf("640 x 480, 64 disparities, preset robust, 1 thread\n");
  std::printf("  matching             %6.3f ms\n", match_ms);
  std::printf("  scan                 %6.3f ms  %4.1f %%\n", scan_ms, 100 * scan_ms / match_ms);
  std::printf("  ground fit, 1 in 30  %6.3f ms  %4.1f %% of every frame\n", fit_ms,
              100 * fit_ms / 30 / match_ms);
  return 0;
}

}  // namespace
}  // namespace stereod

int main() { return stereod::run(); }
