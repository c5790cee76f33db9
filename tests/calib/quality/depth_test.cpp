// SPDX-License-Identifier: BSD-3-Clause
// Compares the depth of the daemon with the error that the report predicts.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "calib/quality/assessment.h"
#include "calib/report/summary.h"
#include "calib/solve/solve.h"
#include "core/geometry/depth.h"
#include "daemon/base/file.h"
#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/config/calibration_file.h"
#include "daemon/tools/tap/frame_listener.h"
#include "tests/support/board_scene.h"
#include "tests/support/network.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_directory.h"

namespace stereod::calib {
namespace {

// The true depth of a scene, seen from the left camera of the calibration found.
class Truth {
 public:
  Truth(const SyntheticScene& scene, const Calibration& found, int frame)
      : exact_(scene.calibration()),
        found_(found),
        disparity_(scene.ground_truth(frame)),
        visible_(scene.visible_in_right(frame)) {}

  // Returns the depth at pixel (x, y) of the rectified left image; NaN where it is unknown.
  double depth_at(int x, int y) const {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    const auto source = source_point(found_.left, {static_cast<double>(x), static_cast<double>(y)});
    const auto at = source ? rectified_point(exact_.left, *source) : std::nullopt;
    if (!at) return kUnknown;
    const int column = static_cast<int>(std::lround(at->x)), row = static_cast<int>(std::lround(at->y));
    if (column < 1 || row < 1 || column + 1 >= disparity_.width() || row + 1 >= disparity_.height()) {
      return kUnknown;
    }
    // Unknown at depth edges, where a matching window covers both sides.
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const float near = disparity_.at(column + dx, row + dy);
        if (visible_.at(column + dx, row + dy) == 0 ||
            !(std::abs(near - disparity_.at(column, row)) < 0.3F)) {
          return kUnknown;
        }
      }
    }
    const RectifiedProjection& p = exact_.left.projection;
    const double z = depth_m(exact_, disparity_.at(column, row));
    const Vector3 point{(at->x - p.cx) / p.fx * z, (at->y - p.cy) / p.fy * z, z};
    return (found_.left.rotation * (transposed(exact_.left.rotation) * point)).z;
  }

 private:
  const Calibration& exact_;
  const Calibration& found_;
  Image<float> disparity_;
  Image<std::uint8_t> visible_;
};

// Returns one frame published by a running daemon.
StereoFrame published_frame(const Calibration& calibration, const TemporaryDirectory& directory) {
  constexpr const char* kUrl = "udpm://239.255.76.67:17668?ttl=0";  // a port used by this test only
  write_calibration(directory / "found.yaml", calibration);
  write_text_file(directory / "config.yaml",
                  "cameras: {source: synthetic, fps: 5}\ncalibration: found.yaml\n"
                  "matcher: {preset: robust, disparities: 96}\nlcm: {url: \"" +
                      std::string(kUrl) + "\", prefix: DEPTH}\n");
  std::optional<StereoFrame> whole;
  FrameAssembler assembler([&](StereoFrame&& frame) {
    if (!whole && frame.complete()) whole = std::move(frame);
  });
  LcmReceiver receiver(kUrl);
  tools::TapOptions tap;
  tap.prefix = "DEPTH";
  tools::listen_for_frames(receiver, tap, assembler);
  ChildProgram daemon(std::filesystem::path(STEREOD_BIN_DIR) / "stereod",
                      {"--config", (directory / "config.yaml").string()}, directory.path());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!whole && std::chrono::steady_clock::now() < deadline) {
    receiver.receive(std::chrono::milliseconds(100));
  }
  daemon.send(SIGTERM);
  const ProgramRun run = daemon.wait();
  if (!whole) throw std::runtime_error("no frame came: " + run.err);
  return std::move(*whole);
}

TEST(Depth, FromDaemon_WithinPrediction) {
  if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
  const SyntheticScene scene;
  const Calibration& exact = scene.calibration();
  const StereoRigEstimate cameras{exact.left.camera, exact.right.camera, stereo_pose(exact)};
  const Board board{9, 6, 0.025};
  const BoardScene boards(cameras, board);
  std::vector<ImagePair> images;
  for (const BoardPose& pose : varied_poses(board, 20)) images.push_back(boards.render(pose, images.size()));
  const SolveResult result = solve(images, {board, board.square_m, LensChoice::kPinhole});
  const Calibration& found = result.calibration;
  const Assessment assessment = assess(result);
  ASSERT_EQ(assessment.verdict.grade, Grade::kGood) << summary_text(result, assessment);
  EXPECT_NEAR(found.baseline_m / exact.baseline_m, 1, 0.003);
  ASSERT_TRUE(result.matched_error_px.has_value());

  const TemporaryDirectory directory;
  const StereoFrame frame = published_frame(found, directory);
  const DisparityMap& disparity = frame.disparity;
  const Truth truth(scene, found, static_cast<int>(frame.summary->left_sequence));
  struct Range {
    double nearest, farthest;
    std::vector<double> parts = {};  // error / predicted error
  };
  Range ranges[] = {{0.3, 0.7}, {0.7, 1.5}, {1.5, 6}};
  for (int y = 8; y < found.image.height - 8; y += 2) {
    for (int x = 8; x < found.image.width - 8; x += 2) {
      if (disparity.at(x, y) <= 0) continue;
      const double known = truth.depth_at(x, y);
      if (!std::isfinite(known)) continue;
      const double measured = depth_m(found, static_cast<double>(disparity.at(x, y)) / frame.units_per_pixel);
      const double predicted = expected_depth_error_m(found, assessment.depth, known);
      for (Range& range : ranges) {
        if (known >= range.nearest && known < range.farthest) {
          range.parts.push_back(std::abs(measured - known) / predicted);
        }
      }
    }
  }
  std::size_t points = 0;
  for (Range& range : ranges) {
    points += range.parts.size();
    if (range.parts.size() < 500) continue;
    std::sort(range.parts.begin(), range.parts.end());
    // 68 % of the points lie within one standard deviation.
    const double two_thirds = range.parts[range.parts.size() * 68 / 100];
    std::printf("%.1f m to %.1f m: error %.2f of the prediction (%zu points)\n", range.nearest,
                range.farthest, two_thirds, range.parts.size());
    EXPECT_LE(two_thirds, 1) << range.nearest << " m to " << range.farthest << " m, " << range.parts.size()
                             << " points";
  }
  EXPECT_GT(points, 20'000U);
}

}  // namespace
}  // namespace stereod::calib
