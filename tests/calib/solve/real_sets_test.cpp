// SPDX-License-Identifier: BSD-3-Clause
// Calibration of real cameras, from public image sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "calib/quality/epipolar_matches.h"
#include "calib/solve/solve.h"
#include "core/rectify/rectify_map.h"
#include "daemon/pipeline/calibration_monitor.h"
#include "daemon/pipeline/epipolar_monitor.h"
#include "tests/calib/datasets.h"
#include "tests/support/board_scene.h"

namespace stereod::calib {
namespace {

namespace fs = std::filesystem;

struct RealSet {
  const char* name;
  fs::path directory;
  double square_m, rms_px, epipolar_px;
  std::size_t pairs;
};

std::vector<RealSet> real_sets() {
  return {{"opencv-doc", "/usr/share/doc/opencv-doc/examples/data", 0.025, 0.3, 0.15, 13},
          {"webcams", datasets() / "calib_sourishg_webcams" / "calib", 0.02423, 0.3, 0.25, 29},
          {"StereoPi", datasets() / "rig_stereopi" / "calib", 0.025, 0.25, 0.12, 19}};
}

std::vector<ImagePair> images_of(const RealSet& set) {
  PairInput input;
  if (std::string(set.name) != "opencv-doc") {
    input.directory = set.directory;
    return read_pairs(input);
  }
  for (int i = 1; i <= 14; ++i) {
    const std::string number = (i < 10 ? "0" : "") + std::to_string(i) + ".jpg";
    if (!fs::exists(set.directory / ("left" + number))) continue;  // there is no 10
    input.left.push_back(set.directory / ("left" + number));
    input.right.push_back(set.directory / ("right" + number));
  }
  return read_pairs(input);
}

// The mean errors over the used pairs without one. Rejecting that pair should not change them, although the mean over
// all pairs changes.
struct Errors {
  double rms_px = 0, epipolar_px = 0;
};
Errors errors_without(const SolveResult& result, std::size_t without) {
  Errors errors;
  double count = 0;
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    if (i == without || result.pairs[i].outcome != PairOutcome::kUsed) continue;
    errors.rms_px += result.pairs[i].error_px * result.pairs[i].error_px;
    errors.epipolar_px += result.pairs[i].check.epipolar_error_px;
    count += 1;
  }
  return {std::sqrt(errors.rms_px / count), errors.epipolar_px / count};
}

void expect_rejected(const SolveResult& moved, const SolveResult& result, std::size_t pair) {
  EXPECT_EQ(moved.pairs[pair].outcome, PairOutcome::kRejected) << pair;
  EXPECT_NE(moved.pairs[pair].reason.find("the board moved"), std::string::npos) << pair;
  EXPECT_EQ(moved.count(PairOutcome::kRejected), 1) << pair;
  const Calibration &a = result.calibration, &b = moved.calibration;
  EXPECT_NEAR(b.left.camera.fx / a.left.camera.fx, 1, 0.05) << pair;
  EXPECT_NEAR(b.right.camera.fx / a.right.camera.fx, 1, 0.05) << pair;
  EXPECT_NEAR(b.baseline_m / a.baseline_m, 1, 0.05) << pair;
  const Errors before = errors_without(result, pair), after = errors_without(moved, pair);
  EXPECT_NEAR(after.rms_px / before.rms_px, 1, 0.05) << pair;
  EXPECT_NEAR(after.epipolar_px / before.epipolar_px, 1, 0.05) << pair;
}

class SolveRealSet : public testing::TestWithParam<std::size_t> {};

TEST_P(SolveRealSet, MovedBoard_ErrorsStay) {
  const RealSet set = real_sets()[GetParam()];
  if (!fs::exists(set.directory)) GTEST_SKIP() << set.directory << " is not here";
  auto images = images_of(set);
  ASSERT_EQ(images.size(), set.pairs);
  SolveOptions options{std::nullopt, set.square_m, LensChoice::kPinhole};
  const SolveResult result = solve(images, options);
  EXPECT_EQ(result.board.columns, 9);
  EXPECT_EQ(result.board.rows, 6);
  EXPECT_LE(result.calibration.quality.rms_px, set.rms_px);
  EXPECT_LE(result.held_out.epipolar_error_px, set.epipolar_px);
  EXPECT_EQ(result.count(PairOutcome::kRejected), 0);

  // Every fourth pair in turn gets the right image of another pair.
  options.board = result.board;
  const std::vector<PairSearch> found = search_boards(images, result.board);
  for (std::size_t pair = 0; pair < images.size(); pair += 4) {
    const std::size_t other = (pair + 5) % images.size();
    std::vector<PairSearch> spoiled = found;
    spoiled[pair].corners.right = found[other].corners.right;
    expect_rejected(solve_found(images, spoiled, options), result, pair);
  }
  // The same, starting with the images.
  images[4].right = copy_of(images[9].right);
  expect_rejected(solve(images, options), result, 4);
}

INSTANTIATE_TEST_SUITE_P(Sets, SolveRealSet, testing::Range<std::size_t>(0, 3), [](const auto& set) {
  return std::string(set.param == 0 ? "OpenCvDoc" : set.param == 1 ? "Webcams" : "StereoPi");
});

// The scenes of the StereoPi rig, rectified by the daemon's lookup table.
class StereoPiScenes : public testing::Test {
 protected:
  void SetUp() override {
    const fs::path rig = datasets() / "rig_stereopi";
    if (!fs::exists(rig)) GTEST_SKIP() << rig << " is not here";
    const RealSet set = real_sets()[2];
    found_ = solve(images_of(set), {std::nullopt, set.square_m, LensChoice::kPinhole}).calibration;
    PairInput input;
    input.directory = rig / "scenes";
    scenes_ = read_pairs(input);
    ASSERT_EQ(scenes_.size(), 7U);
  }

  RectifyMap map(const CameraCalibration& camera, const GrayImage& image, Interpolation interpolation) const {
    return {camera, {image.size(), image.view().stride(), 1}, interpolation};
  }
  GrayImage rectified(const CameraCalibration& camera, const GrayImage& image,
                      Interpolation interpolation) const {
    GrayImage out(image.size());
    map(camera, image, interpolation).gray_rows(image.row(0), {0, image.height()}, out.view());
    return out;
  }
  static std::optional<EpipolarError> measured(const GrayImage& left, const GrayImage& right) {
    return epipolar_error(match_epipolar_points(left.view(), right.view()), left.size());
  }

  Calibration found_;
  std::vector<ImagePair> scenes_;
};

TEST_F(StereoPiScenes, Rectified_RowsAligned) {
  int too_few_points = 0;
  for (const ImagePair& scene : scenes_) {
    for (const Interpolation interpolation : {Interpolation::kNearest, Interpolation::kBilinear}) {
      const GrayImage left = rectified(found_.left, scene.left, interpolation);
      const GrayImage right = rectified(found_.right, scene.right, interpolation);
      const auto found = measured(left, right);
      // One scene has so little texture that nearest-neighbor interpolation leaves 41 points, too few to measure.
      if (!found && interpolation == Interpolation::kNearest) {
        ++too_few_points;
        continue;
      }
      ASSERT_TRUE(found.has_value()) << scene.name;
      EXPECT_LT(std::abs(found->row_offset_px), 0.3) << scene.name;
      EXPECT_LT(found->epipolar_error_px, 0.3) << scene.name;
      // A shift of two rows is measured.
      GrayImage shifted(right.size());
      for (int y = 0; y < right.height(); ++y) {
        std::copy_n(right.row(std::min(y + 2, right.height() - 1)), right.width(), shifted.row(y));
      }
      const auto off = measured(left, shifted);
      ASSERT_TRUE(off.has_value()) << scene.name;
      EXPECT_NEAR(off->row_offset_px, 2, 0.3) << scene.name;
    }
  }
  EXPECT_LE(too_few_points, 1);
}

// The daemon's own monitor of these scenes.
TEST_F(StereoPiScenes, DaemonMonitor_NoAlarm) {
  for (const Interpolation interpolation : {Interpolation::kNearest, Interpolation::kBilinear}) {
    const RectifyMap left_map = map(found_.left, scenes_[0].left, interpolation);
    const RectifyMap right_map = map(found_.right, scenes_[0].right, interpolation);
    const ValidityMask left_mask = left_map.mask(), right_mask = right_map.mask();
    CalibrationMonitor detector;
    for (const ImagePair& scene : scenes_) {
      EpipolarMonitor monitor(scene.left.size(), 0, 64);
      for (int frame = 0; frame < 300; ++frame) {
        monitor.frame_matched({left_map, left_mask, scene.left.row(0)},
                              {right_map, right_mask, scene.right.row(0)}, 1'000'000'000);
      }
      const EpipolarStats stats = monitor.stats();
      EXPECT_EQ(detector.judge(stats), CalibrationFit::kGood) << scene.name;
    }
  }
}

}  // namespace
}  // namespace stereod::calib
