// What the daemon notices of cameras that no longer stand as they were calibrated, and what it does not take
// for it.
#include "daemon/pipeline/epipolar_monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/imagefile/read_image.h"
#include "daemon/service/status_reporter.h"

namespace stereod {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLong_ns = 1'000'000'000;  // so that every frame is looked at

GrayImage lowered(const GrayImage& picture, int rows) {
  GrayImage out(picture.size());
  for (int y = 0; y < out.height(); ++y) {
    std::copy_n(picture.row(std::clamp(y - rows, 0, out.height() - 1)), out.width(), out.row(y));
  }
  return out;
}

struct Side {
  Side(const GrayImage& picture, const CameraCalibration* camera, Interpolation interpolation)
      : map(camera != nullptr ? RectifyMap(*camera, layout(picture), interpolation)
                              : RectifyMap::identity(layout(picture))),
        mask(map.mask()) {}
  static SourceLayout layout(const GrayImage& picture) {
    return {picture.size(), picture.view().stride(), 1};
  }
  RectifyMap map;
  ValidityMask mask;
};

TEST(EpipolarMonitor, NoticesACameraThatIsKnockedAndThatItStandsRightAgain) {
  constexpr int kImages = 4;
  const SyntheticScene scene({640, 480}, kImages);
  const Calibration& c = scene.calibration();
  std::vector<GrayImage> lefts, rights;
  for (int i = 0; i < kImages; ++i) {
    lefts.push_back(scene.render_left(i)), rights.push_back(scene.render_right(i));
  }
  for (const Interpolation interpolation : {Interpolation::kNearest, Interpolation::kBilinear}) {
    EpipolarMonitor monitor(scene.size(), 0, 64);
    CalibrationMonitor detector;
    const Side left(lefts[0], &c.left, interpolation), right(rights[0], &c.right, interpolation);
    // By how many rows the right camera's images are lowered. So many frames that earlier ones are
    // forgotten.
    const auto play = [&](int rows) {
      std::vector<GrayImage> lower;
      for (const GrayImage& picture : rights) lower.push_back(lowered(picture, rows));
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
    EXPECT_EQ(detector.judge(good), "");

    const EpipolarStats knocked = play(3);
    ASSERT_TRUE(knocked.epipolar_error.has_value());
    EXPECT_NEAR(knocked.epipolar_error->epipolar_error_px, 3, 0.5);
    EXPECT_EQ(detector.judge(knocked).rfind("rows of the rectified images do not lie side by side", 0), 0U);

    EXPECT_EQ(detector.judge(play(0)), "");
    // So far that nothing is found.
    EXPECT_EQ(detector.judge(play(120)).rfind("hardly anything of the left image is found", 0), 0U);
    EXPECT_EQ(detector.judge(play(0)), "");
  }
}

// Asked once in thirty frames, as once a second, it knows of a knock with the second answer.
TEST(EpipolarMonitor, NoticesAKnockSoon) {
  const SyntheticScene scene({640, 480}, 1);
  const Calibration& c = scene.calibration();
  const GrayImage l = scene.render_left(0), r = scene.render_right(0);
  for (const int rows : {2, 6, 20}) {
    EpipolarMonitor monitor(scene.size(), 0, 64);
    CalibrationMonitor detector;
    const Side left(l, &c.left, Interpolation::kNearest), right(r, &c.right, Interpolation::kNearest);
    const GrayImage lower = lowered(r, rows);
    std::string verdict;
    const auto second = [&](const GrayImage& picture) {
      for (int frame = 0; frame < 30; ++frame) {
        monitor.frame_matched({left.map, left.mask, l.row(0)}, {right.map, right.mask, picture.row(0)},
                              kLong_ns);
      }
      verdict = detector.judge(monitor.stats());
    };
    for (int s = 0; s < 10; ++s) {
      second(r);
      EXPECT_EQ(verdict, "");
    }
    second(lower);
    second(lower);
    EXPECT_NE(verdict, "") << rows << " rows";
  }
}

TEST(EpipolarMonitor, ProbesOnlyWhatMatchingHasPaidFor) {
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
  EXPECT_LT(searched(10'000), searched(kLong_ns) / 2);  // 0.2 µs are too little for any CPU
}

TEST(EpipolarMonitor, KnowsNothingAtFirst) {
  EpipolarMonitor monitor({640, 480}, 0, 64);
  EXPECT_FALSE(monitor.stats().epipolar_error.has_value());
  EXPECT_EQ(monitor.stats().searched, 0U);
  EXPECT_EQ(CalibrationMonitor().judge(monitor.stats()), "");
}

// That too few points are found for a while says nothing of how the rows lie.
TEST(CalibrationMonitor, KeepsItsVerdictUntilRowsAreSeenTogether) {
  CalibrationMonitor detector;
  EpipolarStats stats;
  stats.epipolar_error = EpipolarError{100, 4, 4, 4, 0};
  EXPECT_NE(detector.judge(stats), "");
  stats.epipolar_error.reset();
  EXPECT_NE(detector.judge(stats), "");
  stats.epipolar_error = EpipolarError{100, 0.8, 0.8, 1, 0};
  EXPECT_NE(detector.judge(stats), "") << "more than when they lie together";
  stats.epipolar_error = EpipolarError{100, 0.2, 0.2, 0.3, 0};
  EXPECT_EQ(detector.judge(stats), "");
  stats.epipolar_error.reset();
  EXPECT_EQ(detector.judge(stats), "");
}

// Once hardly anything is found, a little more is not yet a reason to take it back.
TEST(CalibrationMonitor, MissesWhatIsGoneUntilSomeOfItIsBack) {
  CalibrationMonitor detector;
  EpipolarStats stats;
  stats.searched = 300;
  const auto found = [&](double share) {
    stats.found_share = share;
    return detector.judge(stats);
  };
  EXPECT_EQ(found(0.001), "") << "it has never been otherwise";
  stats.epipolar_error = EpipolarError{100, 0.2, 0.2, 0.3, 0};
  EXPECT_EQ(found(0.6), "");
  stats.epipolar_error.reset();
  stats.usual_share = 0.24;
  EXPECT_EQ(found(0.04), "");
  EXPECT_NE(found(0.02), "");
  EXPECT_NE(found(0.07), "");
  stats.searched = 50;
  EXPECT_NE(found(0.6), "") << "of too few";
  stats.searched = 300;
  EXPECT_EQ(found(0.2), "");
  EXPECT_EQ(found(0.05), "");
}

fs::path datasets() {
  if (const char* set = std::getenv("STEREO_DATASETS")) return set;
  return fs::path(STEREOD_SOURCE_DIR) / ".." / "shared" / "datasets";
}

TEST(EpipolarMonitor, TakesNoRealPairThatIsAlignedForAKnock) {
  if (!fs::exists(datasets())) GTEST_SKIP() << datasets() << " is not here";
  int sets = 0, known = 0;
  CalibrationMonitor detector;  // as if a robot went from one scene to the next
  for (const fs::directory_entry& entry : fs::directory_iterator(datasets())) {
    if (!entry.path().filename().string().starts_with("mb")) continue;
    const GrayImage l = read_gray(entry.path() / "left.png"), r = read_gray(entry.path() / "right.png");
    const Side left(l, nullptr, Interpolation::kNearest), right(r, nullptr, Interpolation::kNearest);
    EpipolarMonitor monitor(l.size(), 0, 64);
    for (int frame = 0; frame < 300; ++frame) {
      monitor.frame_matched({left.map, left.mask, l.row(0)}, {right.map, right.mask, r.row(0)}, kLong_ns);
    }
    const EpipolarStats stats = monitor.stats();
    EXPECT_EQ(detector.judge(stats), "") << entry.path();
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
