// SPDX-License-Identifier: BSD-3-Clause
// Calibration of rendered cameras with known parameters.
#include "calib/solve/solve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calib/base/errors.h"
#include "calib/quality/assessment.h"
#include "calib/report/summary.h"
#include "tests/support/board_scene.h"

namespace stereod::calib {
namespace {

std::vector<ImagePair> rendered(const StereoRigEstimate& cameras, const Board& board, int count) {
  const BoardScene scene(cameras, board);
  std::vector<ImagePair> pairs;
  for (const BoardPose& pose : varied_poses(board, count)) pairs.push_back(scene.render(pose, pairs.size()));
  return pairs;
}

SolveOptions options_for(const Board& board, LensChoice lens = LensChoice::kPinhole) {
  return {board, board.square_m, lens};
}

void expect_found(const Calibration& found, const StereoRigEstimate& truth) {
  EXPECT_NEAR(found.left.camera.fx / truth.left.fx, 1, 0.003);
  EXPECT_NEAR(found.left.camera.fy / truth.left.fy, 1, 0.003);
  EXPECT_NEAR(found.right.camera.fx / truth.right.fx, 1, 0.003);
  EXPECT_NEAR(found.right.camera.fy / truth.right.fy, 1, 0.003);
  const Vector3& t = truth.pose.translation_m;
  EXPECT_NEAR(found.baseline_m / std::sqrt(t.x * t.x + t.y * t.y + t.z * t.z), 1, 0.003);
}

std::string refusal(const std::vector<ImagePair>& images, const SolveOptions& options) {
  try {
    solve(images, options);
  } catch (const CalibrationError& error) {
    return error.what();
  }
  return "none";
}

using testing::HasSubstr;

const Board kBoard{9, 6, 0.025};

const std::vector<ImagePair>& known_images() {
  static const auto images = rendered(known_cameras({640, 480}), kBoard, 20);
  return images;
}

TEST(Solve, KnownCameras_Found) {
  const SolveResult result = solve(known_images(), options_for(kBoard));
  expect_found(result.calibration, known_cameras({640, 480}));
  EXPECT_EQ(result.count(PairOutcome::kRejected), 0);
  EXPECT_EQ(result.count(PairOutcome::kUsed), 20);
  EXPECT_LT(result.calibration.quality.rms_px, 0.15);
  EXPECT_LT(result.held_out.epipolar_error_px, 0.1);
  EXPECT_LT(std::abs(result.held_out.scale_error), 0.002);
  EXPECT_EQ(assess(result).verdict.grade, Grade::kGood) << summary_text(result, assess(result));
}

TEST(Solve, NoBoardGiven_Detected) {
  SolveOptions options{std::nullopt, kBoard.square_m, LensChoice::kPinhole};
  const SolveResult result = solve(known_images(), options);
  EXPECT_EQ(result.board, kBoard);
  expect_found(result.calibration, known_cameras({640, 480}));
}

TEST(Solve, FisheyeCameras_Found) {
  const StereoRigEstimate truth = known_cameras({640, 480}, LensModel::kFisheye);
  const SolveResult result = solve(rendered(truth, kBoard, 20), options_for(kBoard, LensChoice::kFisheye));
  expect_found(result.calibration, truth);
  EXPECT_EQ(result.calibration.left.camera.lens, LensModel::kFisheye);
  EXPECT_LT(result.held_out.epipolar_error_px, 0.1);
}

TEST(Solve, RationalCameras_Found) {
  StereoRigEstimate truth = known_cameras({640, 480});
  for (CameraModel* camera : {&truth.left, &truth.right}) {
    set_distortion(*camera, std::vector<double>{0.6, 0.05, 0.0004, -0.0003, 0, 0.9, 0.15, 0});
  }
  const SolveResult result = solve(rendered(truth, kBoard, 36), options_for(kBoard, LensChoice::kRational));
  expect_found(result.calibration, truth);
  EXPECT_LT(result.held_out.epipolar_error_px, 0.1);
  EXPECT_EQ(assess(result).verdict.grade, Grade::kGood) << summary_text(result, assess(result));
}

// Excess coefficients are fitted to noise. Where no corner was, the distortion may then fold over, which the verdict
// reports.
TEST(Solve, ExcessCoefficients_StillAccurate) {
  for (const LensChoice lens : {LensChoice::kThinPrism, LensChoice::kTilted}) {
    const SolveResult result = solve(known_images(), options_for(kBoard, lens));
    EXPECT_EQ(distortion_of(result.calibration.left.camera).size(), lens == LensChoice::kTilted ? 14U : 12U);
    EXPECT_LT(result.calibration.quality.rms_px, 0.15);
    EXPECT_LT(result.held_out.epipolar_error_px, 0.1);
    EXPECT_NEAR(result.calibration.baseline_m / 0.06, 1, 0.01);
  }
}

// 8×6 looks the same after half a turn, 7×7 after a quarter.
TEST(Solve, AmbiguousBoard_Oriented) {
  for (const Board& board : {Board{8, 6, 0.028}, Board{7, 7, 0.028}}) {
    auto images = rendered(known_cameras({640, 480}), board, 15);
    const SolveResult result = solve(images, options_for(board));
    expect_found(result.calibration, known_cameras({640, 480}));
    EXPECT_EQ(result.count(PairOutcome::kRejected), 0);
  }
}

TEST(Solve, MovedBoard_Rejected) {
  auto images = copy_of(known_images());
  const SolveResult before = solve(images, options_for(kBoard));
  images[5].right = copy_of(images[12].right);
  const SolveResult after = solve(images, options_for(kBoard));
  EXPECT_EQ(after.pairs[5].outcome, PairOutcome::kRejected);
  EXPECT_NE(after.pairs[5].reason.find("the board moved"), std::string::npos) << after.pairs[5].reason;
  EXPECT_EQ(after.count(PairOutcome::kRejected), 1);
  EXPECT_NEAR(after.calibration.left.camera.fx / before.calibration.left.camera.fx, 1, 0.003);
  EXPECT_NEAR(after.calibration.baseline_m / before.calibration.baseline_m, 1, 0.003);
  EXPECT_NEAR(after.calibration.quality.rms_px / before.calibration.quality.rms_px, 1, 0.05);
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (i == 5) continue;
    EXPECT_EQ(after.pairs[i].outcome, before.pairs[i].outcome) << i;
  }
}

// Errors of a pair are measured with a calibration from the other pairs. With few pairs and many coefficients they are
// larger than the errors of the fit.
TEST(Solve, Errors_FromHeldOutPairs) {
  auto images = copy_of(known_images());
  images.resize(7);
  const SolveResult result = solve(images, options_for(kBoard, LensChoice::kThinPrism));
  const Calibration& c = result.calibration;
  double fitted = 0, held_out = 0;
  for (const PairResult& pair : result.pairs) {
    ASSERT_EQ(pair.outcome, PairOutcome::kUsed);
    const BoardPose pose = solve_pose(c.left.camera, kBoard, pair.corners.left);
    fitted += check_pair(c, kBoard, pair.corners, pose).epipolar_error_px / 7;
    held_out += pair.check.epipolar_error_px / 7;
  }
  EXPECT_GT(held_out, 1.02 * fitted);
  EXPECT_NEAR(result.held_out.epipolar_error_px, held_out, 1e-9);
  EXPECT_EQ(c.quality.epipolar_error_px, result.held_out.epipolar_error_px);
}

// A shift of 6 px is a quarter of a square.
TEST(Solve, SlightlyMovedBoard_Rejected) {
  auto images = copy_of(known_images());
  const BoardScene scene(known_cameras({640, 480}), kBoard);
  BoardPose pose = varied_poses(kBoard, 20)[3];
  pose.translation_m.y += 0.004;
  images[3].right = scene.render(pose, 99).right;
  const SolveResult result = solve(images, options_for(kBoard));
  EXPECT_EQ(result.pairs[3].outcome, PairOutcome::kRejected);
  EXPECT_EQ(result.count(PairOutcome::kRejected), 1);
}

TEST(Solve, BlurredAndRepeatedImages_Rejected) {
  auto images = copy_of(known_images());
  GrayImage& blurred = images[5].left;
  for (int pass = 0; pass < 6; ++pass) {
    const GrayImage before = copy_of(blurred);
    for (int y = 0; y < blurred.height(); ++y) {
      for (int x = 3; x + 3 < blurred.width(); ++x) {
        int sum = 0;
        for (int dx = -3; dx <= 3; ++dx) sum += before.at(x + dx, y);
        blurred.at(x, y) = static_cast<std::uint8_t>(sum / 7);
      }
    }
  }
  images[9].left = copy_of(images[8].left), images[9].right = copy_of(images[8].right);
  const SolveResult result = solve(images, options_for(kBoard));
  EXPECT_EQ(result.pairs[5].outcome, PairOutcome::kRejected);
  EXPECT_TRUE(result.pairs[5].reason.starts_with("blurred: edges in the left image") ||
              result.pairs[5].reason.starts_with("no complete board found in the left"))
      << result.pairs[5].reason;
  EXPECT_EQ(result.pairs[9].reason, "has the same two images as pair 8");
}

TEST(Solve, RepeatedLeftImage_BestPairKept) {
  auto images = copy_of(known_images());
  ImagePair wrong{"wrong", copy_of(images[1].left), copy_of(images[4].right)};
  images.insert(images.begin(), std::move(wrong));
  SolveResult result = solve(images, options_for(kBoard));
  EXPECT_THAT(result.pairs[0].reason, HasSubstr("outlier (error "));
  EXPECT_EQ(result.pairs[2].outcome, PairOutcome::kUsed);
  EXPECT_EQ(result.count(PairOutcome::kRejected), 1);

  // A shift of one pixel passes the outlier test of the first stage.
  for (int y = 0; y < 480; ++y) {
    std::copy_n(images[2].right.row(y), 639, images[0].right.row(y) + 1);
  }
  result = solve(images, options_for(kBoard));
  EXPECT_EQ(result.pairs[0].reason, "has the same left image as pair 1, which has a smaller error");
  EXPECT_EQ(result.pairs[2].outcome, PairOutcome::kUsed);
}

TEST(Solve, SameImageLeftAndRight_Rejected) {
  auto images = copy_of(known_images());
  images[2].right = copy_of(images[2].left);
  EXPECT_EQ(solve(images, options_for(kBoard)).pairs[2].reason, "left and right are the same image");
  for (std::size_t i = 3; i < images.size(); ++i) images[i].right = copy_of(images[i].left);
  EXPECT_THAT(refusal(images, options_for(kBoard)), HasSubstr("left and right are the same image"));
}

TEST(Solve, OneCamera_Refused) {
  auto images = copy_of(known_images());
  for (ImagePair& pair : images) {  // the same image with other noise
    for (int y = 0; y < pair.left.height(); ++y) {
      for (int x = 0; x < pair.left.width(); ++x) {
        const int noise = (x * 7 + y * 13) % 5 - 2;
        pair.right.at(x, y) = static_cast<std::uint8_t>(std::clamp(pair.left.at(x, y) + noise, 0, 255));
      }
    }
  }
  EXPECT_THAT(refusal(images, options_for(kBoard)), HasSubstr("left and right are images of one camera"));
}

TEST(Solve, SwappedCameras_Refused) {
  auto images = copy_of(known_images());
  for (ImagePair& pair : images) std::swap(pair.left, pair.right);
  EXPECT_TRUE(refusal(images, options_for(kBoard)).starts_with("left and right are swapped"));
}

TEST(Solve, WrongBoard_NamesRightOne) {
  for (const Board& wrong : {Board{8, 5, 0.025}, Board{10, 7, 0.025}, Board{7, 6, 0.025}}) {
    const std::string sentence = refusal(known_images(), options_for(wrong));
    EXPECT_NE(sentence.find("9×6 inner corners, not"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("use --board 9x6"), std::string::npos) << sentence;
  }
}

TEST(Solve, OneSmallBoard_Ignored) {
  auto images = rendered(known_cameras({640, 480}), {5, 4, 0.04}, 6);
  for (std::size_t i = 1; i < images.size(); ++i) {
    for (int y = 0; y < 480; ++y) {
      std::fill_n(images[i].left.row(y), 640, std::uint8_t{120});
      std::fill_n(images[i].right.row(y), 640, static_cast<std::uint8_t>(100 + i));
    }
  }
  EXPECT_THAT(refusal(images, options_for(kBoard)), HasSubstr("no board with 9×6 inner corners found"));
}

TEST(Solve, NoBoard_Refused) {
  std::vector<ImagePair> images(6);
  for (ImagePair& pair : images) pair = {"gray", GrayImage(320, 240), GrayImage(320, 240)};
  EXPECT_TRUE(refusal(images, options_for(kBoard)).starts_with("no board with 9×6 inner corners found"));
  EXPECT_TRUE(
      refusal(images, {std::nullopt, 0.025, LensChoice::kPinhole}).starts_with("no chessboard found"));
}

TEST(Solve, TooFewPairs_Refused) {
  std::vector<ImagePair> one = copy_of(known_images());
  one.resize(1);
  EXPECT_TRUE(refusal(one, options_for(kBoard)).starts_with("found 1 pair of images; at least 5"));
  std::vector<ImagePair> six = copy_of(known_images());
  six.resize(6);
  six[1].left = GrayImage(640, 480), six[2].right = GrayImage(640, 480);
  const std::string sentence = refusal(six, options_for(kBoard));
  EXPECT_TRUE(sentence.starts_with("found 4 usable pairs")) << sentence;
  EXPECT_NE(sentence.find("pair 1: no complete board found in the left image"), std::string::npos)
      << sentence;
}

// Pairs without a board between the usable pairs change neither the folds nor the number of outliers.
TEST(Solve, GapsBetweenPairs_SameFolds) {
  const std::vector<ImagePair>& images = known_images();
  const SolveResult result = solve(images, options_for(kBoard));
  std::vector<PairSearch> found = search_boards(images, kBoard), spread;
  std::vector<ImagePair> with_gaps;
  for (std::size_t i = 0; i < images.size(); ++i) {
    for (int gap = 0; gap < 5; ++gap) {
      with_gaps.push_back({images[i].name, copy_of(images[i].left), copy_of(images[i].right)});
      spread.push_back(gap == 0 ? found[i] : PairSearch{});
      if (gap > 0) spread.back().problem = "no chessboard in the left image";
    }
  }
  const SolveResult spread_result = solve_found(with_gaps, spread, options_for(kBoard));
  EXPECT_EQ(spread_result.count(PairOutcome::kUsed), result.count(PairOutcome::kUsed));
  EXPECT_DOUBLE_EQ(spread_result.held_out.epipolar_error_px, result.held_out.epipolar_error_px);
  EXPECT_FALSE(std::any_of(spread_result.pairs.begin(), spread_result.pairs.end(),
                           [](const PairResult& p) { return p.is_outlier; }));
}

}  // namespace
}  // namespace stereod::calib
