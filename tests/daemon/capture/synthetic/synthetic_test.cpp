#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/rectify/rectify_map.h"
#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/capture/synthetic/synthetic_source.h"
#include "tests/support/allocation_counter.h"

namespace stereod {
namespace {

using namespace std::chrono_literals;

bool equal(const GrayImage& a, const GrayImage& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.height(); ++y) {
    if (std::memcmp(a.row(y), b.row(y), static_cast<std::size_t>(a.width())) != 0) return false;
  }
  return true;
}

// The brightness at a point of the rectified image, between the pixels of the camera's own image; nothing
// outside. Not by way of RectifyMap, whose nearest neighbors are up to half a pixel off.
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

// How alike two series are whatever gain and black level lie between them: Pearson's correlation, 1 is the
// same.
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

// Of the rectified left image with the right one warped by the ground truth, moved by (dx, dy); over the
// pixels that the mask says are visible, or that it says are not.
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

TEST(SyntheticScene, GroundTruthTakesEveryPointToItself) {
  for (const Size size : {Size{320, 240}, Size{640, 480}}) {
    const SyntheticScene scene(size);
    for (const int frame : {0, 7}) {
      const Correlation true_to_life = warped(scene, frame, 0, 0);
      EXPECT_GT(true_to_life.count(), 0.85 * size.width * size.height);
      EXPECT_GT(true_to_life.value(), 0.95);
      // The likeness falls off to all sides, and its peak lies at the ground truth.
      const auto peak = [&](double dx, double dy) {
        const double before = warped(scene, frame, -dx, -dy).value(),
                     after = warped(scene, frame, dx, dy).value();
        EXPECT_LT(std::max(before, after), true_to_life.value() - 0.005);
        return 0.25 * (after - before) / (2 * true_to_life.value() - before - after);  // of the parabola
      };
      EXPECT_NEAR(peak(0.5, 0), 0, 0.03);  // pixels along the row
      EXPECT_NEAR(peak(0, 0.5), 0, 0.03);  // and across the rows
    }
  }
}

TEST(SyntheticScene, MovingBoxesBelongToTheFrame) {
  const SyntheticScene scene({320, 240});
  const Image<float> now = scene.ground_truth(0), later = scene.ground_truth(6);
  int changed = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) changed += std::abs(now.at(x, y) - later.at(x, y)) > 0.5F ? 1 : 0;
  }
  EXPECT_GT(changed, 1000);
  EXPECT_LT(changed, 320 * 240 / 4);
}

// Against the definition: a point is hidden if another one of its row has a larger disparity and lands where
// it does.
TEST(SyntheticScene, HiddenPixelsAreThoseThatSomethingNearerCovers) {
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
        EXPECT_EQ(mask.at(x, y), 0);  // beyond the border, or not seen at all
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

TEST(SyntheticScene, DisparitiesLieInTheRangeOfAnOrdinaryMatcher) {
  const SyntheticScene scene({640, 480}, 4);
  for (int frame = 0; frame < 4; ++frame) {
    const Image<float> disparity = scene.ground_truth(frame);
    float least = 1000, most = 0;
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        if (std::isnan(disparity.at(x, y))) continue;
        least = std::min(least, disparity.at(x, y));
        most = std::max(most, disparity.at(x, y));
      }
    }
    EXPECT_GT(least, 5);
    EXPECT_LT(most, 60);
    EXPECT_GT(most, 45);
  }
}

TEST(SyntheticScene, IsTheSameOnEveryRunAndAfterEveryLoop) {
  const SyntheticScene one({160, 120}, 6), other({160, 120}, 6);
  for (int frame = 0; frame < 6; ++frame) {
    EXPECT_TRUE(equal(one.render_left(frame), other.render_left(frame)));
    EXPECT_TRUE(equal(one.render_right(frame), other.render_right(frame + 6)));
    EXPECT_FALSE(equal(one.render_left(frame), one.render_left(frame + 1)));
    EXPECT_FALSE(equal(one.render_left(frame), one.render_right(frame)));
  }
}

TEST(SyntheticScene, WorksAtManySizesAndKeepsTheImageCovered) {
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

TEST(SyntheticScene, RefusesWhatItCannotRender) {
  EXPECT_THROW(SyntheticScene({63, 48}), std::invalid_argument);
  EXPECT_THROW(SyntheticScene({64, 47}), std::invalid_argument);
  EXPECT_THROW(SyntheticScene({64, 48}, 0), std::invalid_argument);
  EXPECT_THROW(SyntheticScene({64, 48}, 1, 0), std::invalid_argument);
  EXPECT_THROW(make_synthetic_pair({.size = {64, 48}, .fps = -1}), std::invalid_argument);
}

GrayImage copy_of(const LumaView& luma) {
  GrayImage image(luma.size);
  RectifyMap::identity({luma.size, luma.row_stride, luma.pixel_stride})
      .gray_rows(luma.data, {0, luma.size.height}, image.view());
  return image;
}

TEST(SyntheticSource, LendsTheScenesFramesInOrderAndOverAgain) {
  const SyntheticPair pair = make_synthetic_pair({.size = {96, 64}, .fps = 0, .frames = 3, .skew = 2ms});
  const SyntheticScene scene({96, 64}, 3);
  EXPECT_EQ(pair.calibration, scene.calibration());
  EXPECT_EQ(pair.left->frame_size(), (Size{96, 64}));
  EXPECT_EQ(pair.left->state(), SourceState::kWaiting);
  const std::uint8_t* first = nullptr;
  for (int n = 0; n < 7; ++n) {
    const FrameLease left = pair.left->next(20s), right = pair.right->next(20s);
    ASSERT_TRUE(left && right);
    EXPECT_EQ(left.frame().sequence, static_cast<std::uint32_t>(n));
    EXPECT_EQ(right.frame().sequence, static_cast<std::uint32_t>(n));
    EXPECT_EQ(right.frame().captured_ns - left.frame().captured_ns, 2'000'000);
    EXPECT_TRUE(equal(copy_of(left.frame().luma), scene.render_left(n)));
    EXPECT_TRUE(equal(copy_of(right.frame().luma), scene.render_right(n)));
    if (n == 0) first = left.frame().luma.data;
    EXPECT_EQ(left.frame().luma.data == first, n % 3 == 0);  // lent, not copied
  }
  EXPECT_EQ(pair.left->state(), SourceState::kStreaming);
}

// Where the middle of each dark or bright square of the practice board is in a camera's image.
Point2 seen_at(const CameraCalibration& camera, double from_left_m, const Vector3& in_rectified_left) {
  const Vector3 p{in_rectified_left.x - from_left_m, in_rectified_left.y, in_rectified_left.z};
  const Vector3 ray = transposed(camera.rotation) * p;
  return camera.camera.to_pixel(camera.camera.distort({ray.x / ray.z, ray.y / ray.z}));
}

TEST(SyntheticSource, HoldsABoardWhereBothCamerasSeeAllOfIt) {
  for (const Size size : {Size{320, 240}, Size{640, 360}, Size{240, 240}}) {
    const SyntheticPair pair = make_synthetic_pair({.size = size, .fps = 0, .board = true});
    const double focal = pair.calibration.left.projection.fx;
    const std::vector<BoardPlace> places = varied_places(kPracticeBoard, 0.4 * size.width / focal,
                                                         0.47 * size.height / focal, 0.06, kBoardPlaces);
    int same = 0, frames = 0, held = 0;
    GrayImage last(size);
    // Out of sight for four frames, then two on the way and four at rest for each place.
    for (int n = 0; n < 4 + 6 * kBoardPlaces; ++n, ++frames) {
      const FrameLease left = pair.left->next(20s), right = pair.right->next(20s);
      ASSERT_TRUE(left && right);
      GrayImage now = copy_of(left.frame().luma);
      same += equal(now, last) ? 1 : 0;
      last = std::move(now);
      if (n < 4 || (n - 4) % 6 != 5) continue;
      const BoardPlace& place = places[static_cast<std::size_t>(held++)];
      for (int row = -1; row < kPracticeBoard.rows; ++row) {
        for (int column = -1; column < kPracticeBoard.columns; ++column) {
          const Vector3 on_board = place.rotation * Vector3{(column + 0.5) * kPracticeBoard.square_m,
                                                            (row + 0.5) * kPracticeBoard.square_m, 0};
          const Vector3 at{on_board.x + place.origin_m.x, on_board.y + place.origin_m.y,
                           on_board.z + place.origin_m.z};
          for (const bool is_left : {true, false}) {
            const Point2 p = seen_at(is_left ? pair.calibration.left : pair.calibration.right,
                                     is_left ? 0 : pair.calibration.baseline_m, at);
            ASSERT_TRUE(p.x >= 0 && p.y >= 0 && p.x <= size.width - 1 && p.y <= size.height - 1)
                << size.width << " place " << held << ' ' << column << ' ' << row
                << (is_left ? " left" : " right");
            const LumaView& luma = (is_left ? left : right).frame().luma;
            const int gray = luma.data[std::lround(p.y) * luma.row_stride + std::lround(p.x)];
            EXPECT_EQ(gray < 110, (row + column) % 2 == 0) << gray;
          }
        }
      }
    }
    EXPECT_EQ(held, kBoardPlaces);
    EXPECT_EQ(same, frames - 1 - 2 * kBoardPlaces);  // it rests, and moves twice on each way
  }
}

TEST(SyntheticSource, HoldsABoardForTwoSecondsAtAnyRate) {
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 1000, .board = true});
  const FrameLease first = pair.left->next(20s);
  const std::uint8_t* const away = first.frame().luma.data;
  std::uint32_t frame = 0;
  while (frame < 1900) {
    const FrameLease lease = pair.left->next(20s);
    ASSERT_TRUE(lease);
    frame = lease.frame().sequence;
    if (frame <= 2000) {
      EXPECT_EQ(lease.frame().luma.data, away) << frame;
    }
  }
}

TEST(SyntheticSource, AtRateZeroWaitsForTheLease) {
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 0, .frames = 2});
  FrameLease left = pair.left->next(20s);
  const FrameLease right = pair.right->next(20s);
  ASSERT_TRUE(left && right);
  EXPECT_FALSE(pair.left->next(0ms));
  left.end();
  EXPECT_TRUE(pair.left->next(20s));
}

TEST(SyntheticSource, PacedCamerasAgreeOnNumbersAndTimes) {
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 500, .frames = 2, .skew = -300us});
  const FrameLease first = pair.left->next(20s);
  ASSERT_TRUE(first);
  for (int i = 0; i < 10; ++i) {
    const FrameLease right = pair.right->next(20s);
    ASSERT_TRUE(right);
    const std::int64_t frames = std::int64_t{right.frame().sequence} - std::int64_t{first.frame().sequence};
    EXPECT_EQ(right.frame().captured_ns - first.frame().captured_ns, frames * 2'000'000 - 300'000);
  }
}

TEST(SyntheticSource, StopEndsAWaitForAFrame) {
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 0.001, .frames = 1});
  EXPECT_TRUE(pair.left->next(24h));  // the first one is due at once, the second in a quarter of an hour
  std::jthread stopper([&] {
    std::this_thread::sleep_for(5ms);
    pair.left->stop();
  });
  EXPECT_FALSE(pair.left->next(24h));
  EXPECT_FALSE(pair.left->next(24h));
}

TEST(SyntheticSource, FramesCostNoMemory) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "this build does not count allocations";
  const SyntheticPair pair = make_synthetic_pair({.size = {64, 48}, .fps = 0, .frames = 2});
  const AllocationCounter allocations;
  for (int n = 0; n < 20; ++n) {
    const FrameLease left = pair.left->next(20s), right = pair.right->next(20s);
  }
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace stereod
