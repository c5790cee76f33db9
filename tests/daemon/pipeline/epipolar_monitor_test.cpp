// SPDX-License-Identifier: BSD-3-Clause
// The daemon notices cameras that moved after calibration, and raises no false alarm.
#include "daemon/pipeline/epipolar_monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/imagefile/read_image.h"
#include "daemon/pipeline/calibration_monitor.h"

namespace stereod {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLong_ns = 1'000'000'000;  // matching time that allows to probe every frame

/// Returns the image moved down by @p rows.
GrayImage lowered(const GrayImage& image, int rows) {
  GrayImage out(image.size());
  for (int y = 0; y < out.height(); ++y) {
    std::copy_n(image.row(std::clamp(y - rows, 0, out.height() - 1)), out.width(), out.row(y));
  }
  return out;
}

struct Side {
  Side(const GrayImage& image, const CameraCalibration* camera, Interpolation interpolation)
      : map(camera != nullptr ? RectifyMap(*camera, layout(image), interpolation)
                              : RectifyMap::identity(layout(image))),
        mask(map.mask()) {}
  static SourceLayout layout(const GrayImage& image) { return {image.size(), image.view().stride(), 1}; }
  RectifyMap map;
  ValidityMask mask;
};

TEST(EpipolarMonitor, CameraMovedAndBack_LostAndRecovered) {
  constexpr int kImages = 4;
  const SyntheticScene scene({640, 480}, kImages);
  const Calibration& c = scene.calibration();
  std::vector<GrayImage> lefts, rights;
  for (int i = 0; i < kImages; ++i) {
    lefts.push_back(scene.render_left(i)), rights.push_back(scene.render_right(i));
  }
  for (const Interpolation interpolation : {Interpolation::kNearest, Interpolation::kBilinear}) {
    EpipolarMonitor monitor(scene.size(), 0, 64);
    CalibrationMonitor calibration;
    const Side left(lefts[0], &c.left, interpolation), right(rights[0], &c.right, interpolation);
    // Lowers the images of the right camera by @p rows, for enough frames to replace all earlier points.
    const auto play = [&](int rows) {
      std::vector<GrayImage> lower;
      for (const GrayImage& image : rights) lower.push_back(lowered(image, rows));
      for (std::size_t frame = 0; frame < 1200; ++frame) {
        monitor.frame_matched({left.map, left.mask, lefts[frame % kImages].row(0)},
                              {right.map, right.mask, lower[frame % kImages].row(0)}, kLong_ns);
      }
      return monitor.stats();
    };
    const EpipolarStats good = play(0);
    ASSERT_TRUE(good.epipolar_error.has_value());
    EXPECT_LT(good.epipolar_error->epipolar_error_px, 0.3);
    EXPECT_GT(good.found_share, 0.6);
    EXPECT_EQ(calibration.judge(good), CalibrationFit::kGood);
    EXPECT_EQ(describe(CalibrationFit::kGood, good), "");

    const EpipolarStats moved = play(3);
    ASSERT_TRUE(moved.epipolar_error.has_value());
    EXPECT_NEAR(moved.epipolar_error->epipolar_error_px, 3, 0.5);
    EXPECT_EQ(calibration.judge(moved), CalibrationFit::kMisaligned);
    EXPECT_EQ(describe(CalibrationFit::kMisaligned, moved).rfind("epipolar error ", 0), 0U);

    EXPECT_EQ(calibration.judge(play(0)), CalibrationFit::kGood);
    // Beyond the reach of the far search.
    const EpipolarStats far = play(120);
    EXPECT_EQ(calibration.judge(far), CalibrationFit::kNoMatches);
    EXPECT_EQ(describe(CalibrationFit::kNoMatches, far).rfind("only ", 0), 0U);
    EXPECT_EQ(calibration.judge(play(0)), CalibrationFit::kGood);
  }
}

// With a report every 30 frames, as once a second, the second report after the move shows it.
TEST(EpipolarMonitor, CameraMoved_LostAfterTwoReports) {
  const SyntheticScene scene({640, 480}, 1);
  const Calibration& c = scene.calibration();
  const GrayImage l = scene.render_left(0), r = scene.render_right(0);
  for (const int rows : {2, 6, 20}) {
    EpipolarMonitor monitor(scene.size(), 0, 64);
    CalibrationMonitor calibration;
    const Side left(l, &c.left, Interpolation::kNearest), right(r, &c.right, Interpolation::kNearest);
    const GrayImage lower = lowered(r, rows);
    CalibrationFit fit = CalibrationFit::kGood;
    const auto second = [&](const GrayImage& image) {
      for (int frame = 0; frame < 30; ++frame) {
        monitor.frame_matched({left.map, left.mask, l.row(0)}, {right.map, right.mask, image.row(0)},
                              kLong_ns);
      }
      fit = calibration.judge(monitor.stats());
    };
    for (int s = 0; s < 10; ++s) {
      second(r);
      EXPECT_EQ(fit, CalibrationFit::kGood);
    }
    second(lower);
    second(lower);
    EXPECT_TRUE(calibration_lost(fit)) << rows << " rows";
  }
}

TEST(EpipolarMonitor, TimeBudget_LimitsProbing) {
  const SyntheticScene scene({640, 480}, 1);
  const GrayImage l = scene.render_left(0), r = scene.render_right(0);
  const Side left(l, nullptr, Interpolation::kNearest), right(r, nullptr, Interpolation::kNearest);
  const auto searched = [&](std::int64_t match_ns) {
    EpipolarMonitor monitor(scene.size(), 0, 64);
    for (int frame = 0; frame < 300; ++frame) {
      monitor.frame_matched({left.map, left.mask, l.row(0)}, {right.map, right.mask, r.row(0)}, match_ns);
    }
    return monitor.stats().searched;
  };
  EXPECT_EQ(searched(0), 0U);
  EXPECT_LT(searched(10'000),
            searched(kLong_ns) / 2);  // a budget of 0.2 µs per frame is too little for any CPU
}

TEST(EpipolarMonitor, NoFrames_NoVerdict) {
  EpipolarMonitor monitor({640, 480}, 0, 64);
  EXPECT_FALSE(monitor.stats().epipolar_error.has_value());
  EXPECT_EQ(monitor.stats().searched, 0U);
  EXPECT_EQ(CalibrationMonitor().judge(monitor.stats()), CalibrationFit::kGood);
}

fs::path datasets() {
  if (const char* set = std::getenv("STEREO_DATASETS")) return set;
  return fs::path(STEREOD_SOURCE_DIR) / ".." / "shared" / "datasets";
}

TEST(EpipolarMonitor, AlignedRealPairs_NeverLost) {
  if (!fs::exists(datasets())) GTEST_SKIP() << datasets() << " does not exist";
  int sets = 0, known = 0;
  CalibrationMonitor calibration;  // one for all scenes, as on a robot that moves
  for (const fs::directory_entry& entry : fs::directory_iterator(datasets())) {
    if (!entry.path().filename().string().starts_with("mb")) continue;
    const GrayImage l = read_gray(entry.path() / "left.png"), r = read_gray(entry.path() / "right.png");
    const Side left(l, nullptr, Interpolation::kNearest), right(r, nullptr, Interpolation::kNearest);
    EpipolarMonitor monitor(l.size(), 0, 64);
    for (int frame = 0; frame < 300; ++frame) {
      monitor.frame_matched({left.map, left.mask, l.row(0)}, {right.map, right.mask, r.row(0)}, kLong_ns);
    }
    const EpipolarStats stats = monitor.stats();
    EXPECT_EQ(calibration.judge(stats), CalibrationFit::kGood) << entry.path();
    ++sets;
    if (!stats.epipolar_error) continue;
    ++known;
    EXPECT_LT(stats.epipolar_error->epipolar_error_px, 0.3) << entry.path();
  }
  EXPECT_GE(sets, 18);
  EXPECT_GE(known, 15);
}

}  // namespace
}  // namespace stereod
