// From rendered boards to depth: is it as exact as the report says?
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/report.h"
#include "calib/solve.h"
#include "core/depth.h"
#include "core/match/frame_matcher.h"
#include "core/rectify_map.h"
#include "daemon/capture/synthetic_scene.h"
#include "tests/support/board_scene.h"

namespace stereod {
namespace {

GreyImage rectified(const CameraCalibration& camera, const GreyImage& picture) {
  const RectifyMap map(camera, {picture.size(), picture.view().stride(), 1});
  GreyImage out(picture.size());
  map.grey_rows(picture.row(0), {0, picture.height()}, out.view());
  return out;
}

// What is known of a scene, seen from the left camera of a calibration that was found.
class Truth {
 public:
  Truth(const SyntheticScene& scene, const Calibration& found)
      : exact_(scene.calibration()),
        found_(found),
        disparity_(scene.ground_truth(0)),
        visible_(scene.visible_in_right(0)) {}

  // The depth at pixel (x, y) of the found rectified left image; NaN where it is not known.
  double depth_at(int x, int y) const {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    const auto source = source_point(found_.left, {static_cast<double>(x), static_cast<double>(y)});
    const auto at = source ? rectified_point(exact_.left, *source) : std::nullopt;
    if (!at) return kUnknown;
    const int column = static_cast<int>(std::lround(at->x)), row = static_cast<int>(std::lround(at->y));
    if (column < 1 || row < 1 || column + 1 >= disparity_.width() || row + 1 >= disparity_.height()) {
      return kUnknown;
    }
    // Not at the edges of things: there a window sees both.
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

TEST(Depth, IsAsExactAsTheReportPredicts) {
  const SyntheticScene scene;
  const Calibration& exact = scene.calibration();
  const StereoCameras cameras{exact.left.camera, exact.right.camera, stereo_pose(exact)};
  const Board board{9, 6, 0.025};
  const BoardScene boards(cameras, board);
  std::vector<PicturePair> pictures;
  for (const BoardPose& pose : varied_poses(board, 20))
    pictures.push_back(boards.render(pose, pictures.size()));
  const SolveResult result = solve(pictures, {board, board.square_m, LensChoice::kPinhole});
  const Calibration& found = result.calibration;
  const Assessment assessment = assess(result);
  ASSERT_EQ(assessment.verdict.grade, Grade::kGood) << summary_text(result, assessment);
  EXPECT_NEAR(found.baseline_m / exact.baseline_m, 1, 0.003);

  MatcherOptions options = *matcher_preset("robust");
  options.disparities = 96;
  WorkerPool pool(2);
  FrameMatcher matcher(options, found.image, pool);
  DisparityImage disparity(found.image);
  matcher.match(rectified(found.left, scene.render_left(0)).view(),
                rectified(found.right, scene.render_right(0)).view(), disparity.view());

  const Truth truth(scene, found);
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
      const double measured =
          depth_m(found, static_cast<double>(disparity.at(x, y)) / options.units_per_pixel());
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
    // One standard deviation: two thirds of the points are nearer.
    const double two_thirds = range.parts[range.parts.size() * 68 / 100];
    EXPECT_LE(two_thirds, 1) << range.nearest << " m to " << range.farthest << " m, " << range.parts.size()
                             << " points";
  }
  EXPECT_GT(points, 20'000U);
}

}  // namespace
}  // namespace stereod
