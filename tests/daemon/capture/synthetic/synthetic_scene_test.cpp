// SPDX-License-Identifier: BSD-3-Clause
// The rendered scene: ground truth, occlusion, reproducibility.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "core/rectify/rectify_map.h"
#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/capture/synthetic/synthetic_source.h"

namespace stereod {
namespace {

bool equal(const GrayImage& a, const GrayImage& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.height(); ++y) {
    if (std::memcmp(a.row(y), b.row(y), static_cast<std::size_t>(a.width())) != 0) return false;
  }
  return true;
}

// Returns the brightness at a point of the rectified image, interpolated in the camera's own image; nothing
// outside. Does not use RectifyMap, whose nearest neighbors are up to half a pixel off.
std::optional<double> sample(const GrayImage& image, const CameraCalibration& c, double x, double y) {
  const RectifiedProjection& p = c.projection;
  const Vector3 ray = transposed(c.rotation) * Vector3{(x - p.cx) / p.fx, (y - p.cy) / p.fy, 1};
  const Point2 at = c.camera.to_pixel(c.camera.distort({ray.x / ray.z, ray.y / ray.z}));
  if (!(at.x >= 0 && at.y >= 0 && at.x < image.width() - 1 && at.y < image.height() - 1)) return std::nullopt;
  const int x0 = static_cast<int>(at.x), y0 = static_cast<int>(at.y);
  const double upper = std::lerp(image.at(x0, y0), image.at(x0 + 1, y0), at.x - x0);
  const double lower = std::lerp(image.at(x0, y0 + 1), image.at(x0 + 1, y0 + 1), at.x - x0);
  return std::lerp(upper, lower, at.y - y0);
}

// Similarity of two series, independent of gain and black level: Pearson's correlation, 1 = equal up to
// those.
class Correlation {
 public:
  void add(double a, double b) { n_ += 1, a_ += a, b_ += b, aa_ += a * a, bb_ += b * b, ab_ += a * b; }
  double count() const { return n_; }
  double value() const {
    return (n_ * ab_ - a_ * b_) / std::sqrt((n_ * aa_ - a_ * a_) * (n_ * bb_ - b_ * b_));
  }

 private:
  double n_ = 0, a_ = 0, b_ = 0, aa_ = 0, bb_ = 0, ab_ = 0;
};

// Correlates the rectified left image with the right one warped by the ground truth and shifted by (dx, dy),
// over the pixels that the mask calls visible, or over those that it calls hidden.
Correlation warped(const SyntheticScene& scene, int frame, double dx, double dy, bool visible = true) {
  const Calibration& calibration = scene.calibration();
  const GrayImage left = scene.render_left(frame), right = scene.render_right(frame);
  const Image<float> disparity = scene.ground_truth(frame);
  const Image<std::uint8_t> mask = scene.visible_in_right(frame);
  Correlation result;
  for (int y = 0; y < left.height(); ++y) {
    for (int x = 0; x < left.width(); ++x) {
      if (std::isnan(disparity.at(x, y)) || (mask.at(x, y) != 0) != visible) continue;
      const auto a = sample(left, calibration.left, x, y);
      const auto b = sample(right, calibration.right, x - double{disparity.at(x, y)} + dx, y + dy);
      if (a && b) result.add(*a, *b);
    }
  }
  return result;
}

TEST(SyntheticScene, GroundTruth_MapsPointsOntoThemselves) {
  for (const Size size : {Size{320, 240}, Size{640, 480}}) {
    const SyntheticScene scene(size);
    for (const int frame : {0, 7}) {
      const Correlation unshifted = warped(scene, frame, 0, 0);
      EXPECT_GT(unshifted.count(), 0.85 * size.width * size.height);
      EXPECT_GT(unshifted.value(), 0.95);
      // The correlation decreases in all directions, and its peak lies at the ground truth.
      const auto peak = [&](double dx, double dy) {
        const double before = warped(scene, frame, -dx, -dy).value(),
                     after = warped(scene, frame, dx, dy).value();
        EXPECT_LT(std::max(before, after), unshifted.value() - 0.005);
        return 0.25 * (after - before) / (2 * unshifted.value() - before - after);  // of the parabola
      };
      EXPECT_NEAR(peak(0.5, 0), 0, 0.03);  // pixels along the row
      EXPECT_NEAR(peak(0, 0.5), 0, 0.03);  // and across the rows
    }
  }
}

TEST(SyntheticScene, LaterFrame_BoxesMoved) {
  const SyntheticScene scene({320, 240});
  const Image<float> now = scene.ground_truth(0), later = scene.ground_truth(6);
  int changed = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) changed += std::abs(now.at(x, y) - later.at(x, y)) > 0.5F ? 1 : 0;
  }
  EXPECT_GT(changed, 1000);
  EXPECT_LT(changed, 320 * 240 / 4);
}

// By definition a point is hidden if another point of its row has a larger disparity and the same place in
// the right image.
TEST(SyntheticScene, VisibilityMask_AgreesWithOcclusion) {
  const SyntheticScene scene({320, 240});
  const RectifyMap right(scene.calibration().right, {{320, 240}, 320, 1});
  const Image<float> disparity = scene.ground_truth(3);
  const Image<std::uint8_t> mask = scene.visible_in_right(3);
  int hidden = 0, agreed = 0, compared = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const float d = disparity.at(x, y);
      const float at = static_cast<float>(x) - d;
      if (!(at >= 0)) {
        EXPECT_EQ(mask.at(x, y), 0);  // outside one of the images
        continue;
      }
      if (right.offset(static_cast<int>(std::lround(at)), y) < 0) continue;
      bool covered = false;
      for (int other = x + 1; other < 320; ++other) {
        const float nearer = disparity.at(other, y);
        if (nearer > d + 1 && std::abs(static_cast<float>(other) - nearer - at) < 0.75F) covered = true;
      }
      ++compared;
      hidden += covered ? 1 : 0;
      agreed += covered == (mask.at(x, y) == 0) ? 1 : 0;
    }
  }
  EXPECT_GT(hidden, 500);
  EXPECT_GT(agreed, 0.99 * compared);
  EXPECT_LT(warped(scene, 3, 0, 0, false).value(), 0.5);  // there the right image shows something else
}

TEST(SyntheticScene, Vga_DisparitiesWithin5To60) {
  const SyntheticScene scene({640, 480}, 4);
  for (int frame = 0; frame < 4; ++frame) {
    const Image<float> disparity = scene.ground_truth(frame);
    float minimum = 1000, maximum = 0;
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        if (std::isnan(disparity.at(x, y))) continue;
        minimum = std::min(minimum, disparity.at(x, y));
        maximum = std::max(maximum, disparity.at(x, y));
      }
    }
    EXPECT_GT(minimum, 5);
    EXPECT_LT(maximum, 60);
    EXPECT_GT(maximum, 45);
  }
}

TEST(SyntheticScene, RunsAndLoops_Reproducible) {
  const SyntheticScene one({160, 120}, 6), other({160, 120}, 6);
  for (int frame = 0; frame < 6; ++frame) {
    EXPECT_TRUE(equal(one.render_left(frame), other.render_left(frame)));
    EXPECT_TRUE(equal(one.render_right(frame), other.render_right(frame + 6)));
    EXPECT_FALSE(equal(one.render_left(frame), one.render_left(frame + 1)));
    EXPECT_FALSE(equal(one.render_left(frame), one.render_right(frame)));
  }
}

TEST(SyntheticScene, ManySizes_ImageCovered) {
  for (const Size size : {Size{64, 48}, Size{65, 49}, Size{752, 480}, Size{1280, 720}, Size{300, 300}}) {
    const SyntheticScene scene(size, 1);
    EXPECT_EQ(problem_with(scene.calibration()), std::nullopt);
    EXPECT_EQ(scene.calibration().id, calibration_id(scene.calibration()));
    EXPECT_EQ(scene.render_left(0).size(), size);
    for (const CameraCalibration& camera : {scene.calibration().left, scene.calibration().right}) {
      const RectifyMap map(camera, {size, size.width, 1});
      int outside = 0;
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) outside += map.offset(x, y) < 0 ? 1 : 0;
      }
      EXPECT_LT(outside, 0.05 * size.width * size.height) << size.width << 'x' << size.height;
    }
  }
}

TEST(SyntheticScene, InvalidArguments_Throws) {
  EXPECT_THROW(SyntheticScene({63, 48}), std::invalid_argument);
  EXPECT_THROW(SyntheticScene({64, 47}), std::invalid_argument);
  EXPECT_THROW(SyntheticScene({64, 48}, 0), std::invalid_argument);
  EXPECT_THROW(SyntheticScene({64, 48}, 1, 0), std::invalid_argument);
  EXPECT_THROW(make_synthetic_pair({.size = {64, 48}, .fps = -1}), std::invalid_argument);
}

}  // namespace
}  // namespace stereod
