// What is made of a calibration's numbers: coverage, depth error, verdict, consensus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "calib/quality/coverage.h"
#include "calib/quality/depth_error.h"
#include "calib/quality/edge_width.h"
#include "calib/quality/verdict.h"
#include "calib/report/html.h"
#include "calib/solve/pair_consensus.h"
#include "core/geometry/depth.h"
#include "daemon/base/progress.h"
#include "tests/support/board_scene.h"

namespace stereod {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Coverage, CountsCellsAndNamesWhatIsEmpty) {
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

TEST(DepthError, GrowsWithTheSquareOfDepth) {
  const Calibration c = simple();
  const DepthErrorSources third{0.3, 0};
  // 0.3 px at 2 m: 4/50·0.3.
  EXPECT_NEAR(expected_depth_error_m(c, third, 2), 0.024, 1e-12);
  EXPECT_NEAR(expected_depth_error_m(c, third, 4), 0.096, 1e-12);
  // It is what depth really changes by for such a change of disparity.
  EXPECT_NEAR(depth_m(c, disparity_at(c, 2) - 0.3) - 2, 0.024, 0.001);
  EXPECT_NEAR(expected_depth_error_m(c, {0.3, 0.05}, 2), std::hypot(0.024, 0.1), 1e-12);
}

QualityStats fine() {
  QualityStats f;
  f.pairs_used = 16, f.rms_px = 0.2, f.epipolar_error_px = 0.1, f.max_epipolar_error_px = 0.2;
  f.left_coverage = f.right_coverage = 0.8;
  return f;
}

TEST(Verdict, IsGoodWhenEverythingIs) {
  const Verdict verdict = judge(fine());
  EXPECT_EQ(verdict.grade, Grade::kGood);
  EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr("within 0.10 px")));
}

TEST(Verdict, SaysWhatIsWrong) {
  struct Case {
    void (*spoil)(QualityStats&);
    Grade grade;
    const char* word;
  };
  const Case cases[] = {
      {[](QualityStats& f) { f.epipolar_error_px = 0.3; }, Grade::kUsable, "0.30 px apart"},
      {[](QualityStats& f) { f.epipolar_error_px = 0.6; }, Grade::kDoAgain, "0.60 px apart"},
      {[](QualityStats& f) { f.epipolar_error_px = std::nan(""); }, Grade::kDoAgain, "px apart"},
      {[](QualityStats& f) { f.max_epipolar_error_px = 1.2; }, Grade::kUsable, "1.20 px off"},
      {[](QualityStats& f) { f.rms_px = 0.7; }, Grade::kUsable, "0.70 px from where"},
      {[](QualityStats& f) { f.rms_px = 2; }, Grade::kDoAgain, "flat and stiff"},
      {[](QualityStats& f) {
         f.right_coverage = 0.5, f.empty_parts = {"the top", "the middle"};
       },
       Grade::kUsable, "only 50 % of the right image, not in the top and the middle"},
      {[](QualityStats& f) { f.left_coverage = 0.2; }, Grade::kDoAgain, "only 20 % of the left"},
      {[](QualityStats& f) { f.breakdown = 0.01; }, Grade::kUsable, "breaks down in 1.0 %"},
      {[](QualityStats& f) { f.breakdown = 0.1; }, Grade::kDoAgain, "breaks down in 10.0 %"},
      {[](QualityStats& f) { f.pairs_used = 5; }, Grade::kUsable, "Only 5 pairs"},
      {[](QualityStats& f) { f.pairs_left_out = 9; }, Grade::kDoAgain, "9 pairs do not agree"},
  };
  for (const Case& each : cases) {
    QualityStats figures = fine();
    each.spoil(figures);
    const Verdict verdict = judge(figures);
    EXPECT_EQ(verdict.grade, each.grade) << each.word;
    EXPECT_THAT(verdict.reasons, ElementsAre(HasSubstr(each.word)));
  }
}

// A third of the boards moved between the two images; each other pair is exact.
TEST(PairConsensus, FindsThePairsThatAgree) {
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({640, 480});
  std::vector<PosedPair> pairs;
  const auto poses = varied_poses(board, 12);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const BoardPose& right_sees = i % 3 == 1 ? poses[(i + 5) % poses.size()] : poses[i];
    PosedPair pair{{}, poses[i], seen_from_right(cameras.pose, right_sees)};
    for (std::size_t c = 0; c < board.corner_count(); ++c) {
      const auto project = [&](const CameraModel& camera, const BoardPose& pose) {
        const Vector3 p = pose.rotation * board_point(board, c);
        const double z = p.z + pose.translation_m.z;
        return camera.to_pixel(
            camera.distort({(p.x + pose.translation_m.x) / z, (p.y + pose.translation_m.y) / z}));
      };
      pair.corners.left.push_back(project(cameras.left, pair.in_left));
      pair.corners.right.push_back(project(cameras.right, pair.in_right));
    }
    pairs.push_back(pair);
  }
  const std::vector<double> errors = disagreement_px({cameras.left, cameras.right, {}}, board, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i % 3 == 1) {
      EXPECT_GT(errors[i], 5) << i;
    } else {
      EXPECT_LT(errors[i], 1e-6) << i;
    }
  }
}

TEST(PairGeometry, TheFittedPoseIsTheTrueOne) {
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({640, 480});
  const BoardPose truth = board_at(board, {0.05, -0.03, 0.6}, {0.4, -0.3, 0.2});
  BoardPair pair;
  for (std::size_t c = 0; c < board.corner_count(); ++c) {
    const auto project = [&](const CameraModel& camera, const BoardPose& pose) {
      const Vector3 p = pose.rotation * board_point(board, c);
      const double z = p.z + pose.translation_m.z;
      return camera.to_pixel(
          camera.distort({(p.x + pose.translation_m.x) / z, (p.y + pose.translation_m.y) / z}));
    };
    pair.left.push_back(project(cameras.left, truth));
    pair.right.push_back(project(cameras.right, seen_from_right(cameras.pose, truth)));
  }
  BoardPose guess = truth;
  guess.translation_m = {0.1, 0.02, 0.5};
  guess.rotation = rotation_about({0.1, 0.1, 0}) * guess.rotation;
  const BoardPose found = fitted_pose(cameras, board, pair, guess);
  EXPECT_NEAR(pair_error_px(cameras, board, pair, found), 0, 1e-6);
  EXPECT_NEAR(found.translation_m.z, truth.translation_m.z, 1e-7);

  const Calibration c = rectified_pair(cameras.left, cameras.right, cameras.pose);
  const PairCheck exact = check_pair(c, board, pair, found);
  EXPECT_NEAR(exact.epipolar_error_px, 0, 1e-6);
  EXPECT_NEAR(exact.disparity_error_px, 0, 1e-5);
  EXPECT_NEAR(exact.scale_error, 0, 1e-8);
  Calibration longer = c;
  longer.baseline_m *= 1.02;
  EXPECT_NEAR(check_pair(longer, board, pair, found).scale_error, 0.02, 1e-6);
  for (Point2& p : pair.right) p.y += 0.4;
  EXPECT_NEAR(check_pair(c, board, pair, found).epipolar_error_px, 0.4, 0.05);
}

TEST(PairConsensus, HoldsBackAFifthEvenlySpread) {
  EXPECT_THAT(evenly_spread(3, 13), ElementsAre(2U, 6U, 10U));
  EXPECT_THAT(evenly_spread(1, 5), ElementsAre(2U));
  EXPECT_EQ(median({3, 1, 2}), 2);
}

TEST(EdgeWidth, GrowsWithBlurInEitherDirection) {
  const Board board{9, 6, 0.025};
  const StereoRigEstimate cameras = known_cameras({640, 480});
  const BoardPose pose = board_at(board, {0, 0, 0.4}, {0.1, 0.1, 0.3});
  const ImagePair pair = BoardScene(cameras, board).render(pose, 1);
  Corners corners;
  for (std::size_t c = 0; c < board.corner_count(); ++c) {
    const Vector3 p = pose.rotation * board_point(board, c);
    const double z = p.z + pose.translation_m.z;
    corners.push_back(cameras.left.to_pixel(
        cameras.left.distort({(p.x + pose.translation_m.x) / z, (p.y + pose.translation_m.y) / z})));
  }
  const double sharp = edge_width_px(pair.left.view(), board, corners);
  EXPECT_NEAR(sharp, 1.8, 0.4);  // a ramp of two pixels, less a tenth at each end, and the interpolation
  for (const bool across : {true, false}) {
    GrayImage blurred = copy_of(pair.left);
    for (int y = 4; y + 4 < blurred.height(); ++y) {
      for (int x = 4; x + 4 < blurred.width(); ++x) {
        int sum = 0;
        for (int d = -4; d <= 4; ++d) sum += across ? pair.left.at(x + d, y) : pair.left.at(x, y + d);
        blurred.at(x, y) = static_cast<std::uint8_t>(sum / 9);
      }
    }
    EXPECT_GT(edge_width_px(blurred.view(), board, corners), 6) << across;
  }
  EXPECT_GT(edge_width_px(GrayImage(640, 480).view(), board, corners), 20);  // no edge at all
}

TEST(EdgeWidth, MayBeWiderWhereTheSameAngleHasMorePixels) {
  EXPECT_NEAR(blur_limit_px({320, 240}), 3.7, 0.05);
  EXPECT_NEAR(blur_limit_px({640, 480}), 6.0, 0.05);
  EXPECT_NEAR(blur_limit_px({1280, 720}), 11.2, 0.05);
  EXPECT_NEAR(blur_limit_px({1920, 1080}), 16.5, 0.05);
  EXPECT_EQ(blur_limit_px({480, 640}), blur_limit_px({640, 480}));
  EXPECT_GT(blur_limit_px({64, 48}), 2.5);  // what is sharp stays so in the smallest image

  // One lens out of focus by one angle, seen with more and more pixels: refused with all of them or with
  // none.
  const Board board{9, 6, 0.025};
  const BoardPose pose = board_at(board, {0, 0, 0.4}, {0.1, 0.1, 0.3});
  for (const int width : {320, 1280}) {
    const StereoRigEstimate cameras = known_cameras({width, width * 3 / 4});
    const ImagePair pair = BoardScene(cameras, board).render(pose, 1);
    Corners corners;
    for (std::size_t c = 0; c < board.corner_count(); ++c) {
      const Vector3 p = pose.rotation * board_point(board, c);
      const double z = p.z + pose.translation_m.z;
      corners.push_back(cameras.left.to_pixel(
          cameras.left.distort({(p.x + pose.translation_m.x) / z, (p.y + pose.translation_m.y) / z})));
    }
    for (const double angle : {0.004, 0.016}) {  // half of the blur's width, of the image's
      const int reach = static_cast<int>(std::lround(angle * width / 2));
      GrayImage blurred = copy_of(pair.left);
      for (int y = 0; y < blurred.height(); ++y) {
        for (int x = reach; x + reach < width; ++x) {
          int sum = 0;
          for (int d = -reach; d <= reach; ++d) sum += pair.left.at(x + d, y);
          blurred.at(x, y) = static_cast<std::uint8_t>(sum / (2 * reach + 1));
        }
      }
      const bool refused = edge_width_px(blurred.view(), board, corners) > blur_limit_px(blurred.size());
      EXPECT_EQ(refused, angle > 0.01) << width << ' ' << angle;
    }
  }
}

TEST(Words, AreSafeAndReadable) {
  EXPECT_EQ(escaped("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
  EXPECT_EQ(length_in_words(0.0034), "3.4 mm");
  EXPECT_EQ(length_in_words(0.042), "4.2 cm");
  EXPECT_EQ(length_in_words(0.42), "42 cm");
  EXPECT_EQ(length_in_words(1.34), "1.3 m");
  EXPECT_EQ(length_in_words(std::numeric_limits<double>::infinity()), "unknown");
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");  // RFC 4648
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(progress_bar(1, 4, 8), "[##......]");
  EXPECT_EQ(progress_bar(0, 0, 3), "[###]");
}

}  // namespace
}  // namespace stereod
