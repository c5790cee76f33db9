// SPDX-License-Identifier: BSD-3-Clause
// Coverage, depth error, distortion foldover and verdict.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calib/quality/coverage.h"
#include "calib/quality/depth_error.h"
#include "calib/quality/distortion_foldover.h"
#include "calib/quality/verdict.h"
#include "core/geometry/depth.h"

namespace stereod::calib {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Coverage, Cells_CountedAndNamed) {
  Coverage coverage({640, 480});
  EXPECT_EQ(coverage.share(), 0);
  EXPECT_EQ(coverage.empty_parts().size(), 9U);
  Corners everywhere;
  for (double y = 40; y < 480; y += 80) {
    for (double x = 40; x < 640; x += 80) {
      if (x < 160 && y < 160) continue;  // not the upper left
      everywhere.push_back({x, y});
    }
  }
  coverage.add(everywhere);
  coverage.add({{-1, 5}, {640, 5}, {5, 480}});  // outside
  EXPECT_EQ(coverage.count(0, 0), 0);
  EXPECT_EQ(coverage.count(7, 5), 1);
  EXPECT_DOUBLE_EQ(coverage.share(), 44.0 / 48);
  EXPECT_THAT(coverage.empty_parts(), ElementsAre("the upper left"));
}

Calibration simple() {
  Calibration c;
  c.image = {640, 480};
  c.left.projection = c.right.projection = {500, 500, 320, 240};
  c.baseline_m = 0.1;
  return c;
}

TEST(DepthError, Depth_GrowsQuadratically) {
  const Calibration c = simple();
  const DepthErrorSources third{0.3, 0};
  // 0.3 px at 2 m: 4/50·0.3.
  EXPECT_NEAR(expected_depth_error_m(c, third, 2), 0.024, 1e-12);
  EXPECT_NEAR(expected_depth_error_m(c, third, 4), 0.096, 1e-12);
  // Equals the change of depth for this change of disparity.
  EXPECT_NEAR(depth_m(c, disparity_at(c, 2) - 0.3) - 2, 0.024, 0.001);
  EXPECT_NEAR(expected_depth_error_m(c, {0.3, 0.05}, 2), std::hypot(0.024, 0.1), 1e-12);
}

QualityStats fine() {
  QualityStats f;
  f.pairs_used = 16, f.rms_px = 0.2, f.epipolar_error_px = 0.1, f.max_epipolar_error_px = 0.2;
  f.left_coverage = f.right_coverage = 0.8;
  return f;
}

TEST(Verdict, AllGood_Good) {
  const Verdict verdict = evaluate(fine());
  EXPECT_EQ(verdict.grade, Grade::kGood);
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("Epipolar error 0.10 px")));
}

TEST(Verdict, OneProblem_Named) {
  struct Case {
    void (*spoil)(QualityStats&);
    Grade grade;
    const char* word;
  };
  const Case cases[] = {
      {[](QualityStats& f) { f.epipolar_error_px = 0.3; }, Grade::kUsable, "Epipolar error 0.30 px"},
      {[](QualityStats& f) { f.epipolar_error_px = 0.6; }, Grade::kDoAgain, "Epipolar error 0.60 px"},
      {[](QualityStats& f) { f.epipolar_error_px = std::nan(""); }, Grade::kDoAgain, "Epipolar error "},
      {[](QualityStats& f) { f.max_epipolar_error_px = 1.2; }, Grade::kUsable, "1.20 px on the worst"},
      {[](QualityStats& f) { f.rms_px = 0.7; }, Grade::kUsable, "Reprojection error 0.70 px"},
      {[](QualityStats& f) { f.rms_px = 2; }, Grade::kDoAgain, "flat and stiff"},
      {[](QualityStats& f) {
         f.right_coverage = 0.5, f.empty_parts = {"the top", "the middle"};
       },
       Grade::kUsable, "only 50 % of the right image, too little of the top and the middle"},
      {[](QualityStats& f) { f.left_coverage = 0.2; }, Grade::kDoAgain, "only 20 % of the left"},
      {[](QualityStats& f) { f.foldover = 0.01; }, Grade::kUsable, "folds over in 1.0 %"},
      {[](QualityStats& f) { f.foldover = 0.1; }, Grade::kDoAgain, "folds over in 10.0 %"},
      {[](QualityStats& f) { f.pairs_used = 5; }, Grade::kUsable, "Only 5 pairs"},
      {[](QualityStats& f) { f.outliers = 9; }, Grade::kDoAgain, "9 pairs are outliers"},
  };
  for (const Case& each : cases) {
    QualityStats stats = fine();
    each.spoil(stats);
    const Verdict verdict = evaluate(stats);
    EXPECT_EQ(verdict.grade, each.grade) << each.word;
    EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr(each.word)));
  }
}

TEST(DistortionFoldover, KnownLens_Share) {
  CameraModel camera{{640, 480}, 500, 500, 319.5, 239.5};
  EXPECT_EQ(distortion_foldover(camera), 0);
  camera.k1 = -0.3, camera.k2 = 0.1;
  EXPECT_EQ(distortion_foldover(camera), 0);
  // Folds over where 1 + 3·k1·r² = 0, at r = 1/3, which maps to 2/9 from the center: 111 px.
  camera.k1 = -3, camera.k2 = 0;
  EXPECT_NEAR(distortion_foldover(camera), 1 - 3.14159 * 111.1 * 111.1 / (640 * 480), 0.02);
  camera.k1 = -1e6;
  EXPECT_GT(distortion_foldover(camera), 0.99);
  camera.k1 = 1e300, camera.k3 = -1e300;
  EXPECT_GT(distortion_foldover(camera), 0.9);

  CameraModel fisheye{{640, 480}, 200, 200, 319.5, 239.5};
  fisheye.lens = LensModel::kFisheye;
  EXPECT_EQ(distortion_foldover(fisheye), 0);  // although its corners are beyond 90°
  // Folds over where 1 + 3·k1·θ² = 0, at θ = 0.577, which maps to 2/3 of that: 77 px.
  fisheye.k1 = -1;
  EXPECT_NEAR(distortion_foldover(fisheye), 1 - 3.14159 * 77 * 77 / (640 * 480), 0.02);
}

}  // namespace
}  // namespace stereod::calib
