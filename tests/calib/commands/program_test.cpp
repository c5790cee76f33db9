// SPDX-License-Identifier: BSD-3-Clause
// stereo-calibrate as a process: solve, check and board.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "calib/board/board_finder.h"
#include "core/geometry/stereo_rectification.h"
#include "daemon/base/file.h"
#include "daemon/config/calibration_file.h"
#include "daemon/imagefile/read_image.h"
#include "daemon/imagefile/write_image.h"
#include "tests/calib/commands/program_fixture.h"
#include "tests/support/board_scene.h"

namespace stereod::calib {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST_F(Program, Solve_WritesCalibrationAndReport) {
  const ProgramRun result = run({"solve", pairs_->path().string(), "--square", "25mm", "-o", file("c.yaml"),
                                 "--report", file("r.html")});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_THAT(result.out, StartsWith("verdict: good"));
  EXPECT_THAT(result.out, HasSubstr("18 used, 0 rejected"));
  const Calibration found = read_calibration(file("c.yaml"));
  EXPECT_NEAR(found.left.camera.fx / known_cameras(kImage).left.fx, 1, 0.003);
  EXPECT_EQ(found.quality.pairs_used, 18);

  const std::string page = text_of(file("r.html"));
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  for (const char* word :
       {"<h1>good</h1>", "Coverage", "A rectified pair", "Expected depth error", "All pairs",
        "left_17.png, right_17.png", "held out", "epipolar", "0.5 m", "10 m"}) {
    EXPECT_THAT(page, HasSubstr(word));
  }
  // The page refers to nothing outside.
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
}

TEST_F(Program, Solve_SideBySideImages) {
  std::vector<std::string> arguments{"solve", "--square", "2.5cm",        "--board",
                                     "9x6",   "-o",       file("c.yaml"), "--side-by-side"};
  for (std::size_t i = 0; i < 8; ++i) {
    const GrayImage l = read_gray(left(i)), r = read_gray(right(i));
    GrayImage both(2 * kImage.width, kImage.height);
    for (int y = 0; y < kImage.height; ++y) {
      std::copy_n(l.row(y), kImage.width, both.row(y));
      std::copy_n(r.row(y), kImage.width, both.row(y) + kImage.width);
    }
    write_png(directory_ / ("both_" + two_digits(i)), both.view());
    arguments.push_back(file("both_" + two_digits(i)));
  }
  const ProgramRun result = run(arguments);
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_EQ(read_calibration(file("c.yaml")).image, kImage);
}

TEST_F(Program, BadInput_OneSentenceNoChange) {
  write_text_file(directory_ / "c.yaml", "what was there before");
  const StereoRigEstimate cameras = known_cameras(kImage);
  write_calibration(directory_ / "good.yaml", rectified_pair(cameras.left, cameras.right, cameras.pose));
  write_png(directory_ / "small.png", GrayImage(64, 48).view());
  write_text_file(directory_ / "text.png", "no image");
  std::vector<std::string> lefts, rights;
  for (std::size_t i = 0; i < 6; ++i) lefts.push_back(left(i)), rights.push_back(right(i));
  const auto solve = [&](std::vector<std::string> l, std::vector<std::string> r,
                         const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"solve", "-o", file("c.yaml"), "--left"};
    arguments.insert(arguments.end(), l.begin(), l.end());
    arguments.push_back("--right");
    arguments.insert(arguments.end(), r.begin(), r.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const std::vector<std::string> sane{"--board", "9x6", "--square", "25mm"};
  auto with = [](std::vector<std::string> list, const std::string& file) {
    list[2] = file;
    return list;
  };
  struct Case {
    std::vector<std::string> arguments;
    const char* sentence;
  };
  const std::vector<Case> cases = {
      {solve(lefts, rights, {"--board", "8x5", "--square", "25mm"}),
       "9×6 inner corners, not 8×5 inner corners"},
      {solve(lefts, rights, {"--board", "nine", "--square", "25mm"}), "--board: found 'nine'"},
      {solve(lefts, rights, {"--board", "9x6", "--square", "25"}), "--square: found '25'"},
      {solve(lefts, rights, {"--board", "9x6"}), "--square"},
      {solve(lefts, rights, {"--square", "25mm", "--lens", "glass"}), "--lens: found 'glass'"},
      {solve(rights, lefts, sane), "left and right are swapped"},
      {solve(lefts, lefts, sane), "left and right are the same image"},
      {solve({lefts[0]}, {rights[0]}, sane), "found 1 pair of images"},
      {solve({lefts[0]}, rights, sane), "found 1 left and 6 right images"},
      {solve(with(lefts, file("small.png")), rights, sane), "size is 64×48 px"},
      {solve(with(lefts, file("text.png")), rights, sane), "text.png"},
      {solve(with(lefts, file("none.png")), rights, sane), "none.png"},
      {{"solve", "--square", "25mm", "-o", file("c.yaml")}, "no images given"},
      {{"solve", directory_.path().string(), "--square", "25mm", "-o", file("c.yaml")},
       "no stereo pair found"},
      {{"solve", pairs_->path().string(), "--square", "25mm", "-o", file("none/c.yaml")},
       "the directory to write to does not exist"},
      {{"solve", pairs_->path().string(), "--square", "25mm", "--sqare", "1"}, "--sqare"},
      {{"check", file("c.yaml"), pairs_->path().string()}, "allowed a map of keys and values"},
      {{"check", file("none.yaml"), pairs_->path().string()}, "the file does not exist"},
      {{"check", file("good.yaml"), pairs_->path().string(), "--daemon"}, "not both"},
      {{"check", file("good.yaml"), "--daemon", "--config", "x.yaml"}, "give one source of images"},
      {{"check", file("good.yaml"), "--config", file("none.yaml")}, "the file does not exist"},
      {{"check", file("good.yaml")}, "no images given"},
      {{"import", "-o", file("c.yaml")}, "--ros, --opencv or --kalibr"},
      {{"import", "--kalibr", file("none.yaml"), "-o", file("c.yaml")}, "the file does not exist"},
      {{"import", "--opencv", left(0), left(1), "-o", file("c.yaml")}, "FileStorage"},
      {{"board", "--paper", "a9"}, "--paper: found 'a9'"},
      {{"board", "-o", file("board.doc")}, "use .pdf or .svg"},
      {{"capture", "--config", file("none.yaml"), "--square", "25mm"}, "the file does not exist"},
      {{"capture", "--square", "25mm", "-o", file("c.yaml")}, "give one source of images"},
      {{}, "subcommand"},
  };
  for (const Case& each : cases) {
    const ProgramRun result = run(each.arguments);
    EXPECT_EQ(result.status, 2) << each.sentence << result.out;
    EXPECT_THAT(result.err, HasSubstr(each.sentence));
    EXPECT_THAT(result.err, StartsWith("stereo-calibrate: "));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(text_of(file("c.yaml")), "what was there before") << each.sentence;
  }
}

// The board stays in the middle: solvable, but with too little coverage.
TEST_F(Program, BadResult_KeepsOldFile) {
  write_text_file(directory_ / "c.yaml", "what was there before");
  const BoardScene scene(known_cameras(kImage), kBoard);
  fs::create_directory(directory_ / "pairs");
  for (std::size_t i = 0; i < 8; ++i) {
    const double tilt = 0.1 * static_cast<double>(i) - 0.3;
    const ImagePair pair = scene.render(board_at(kBoard, {0.03, 0, 0.6}, {tilt, -0.2 + 0.5 * tilt, 0}), i);
    write_png(directory_ / ("pairs/left_" + two_digits(i)), pair.left.view());
    write_png(directory_ / ("pairs/right_" + two_digits(i)), pair.right.view());
  }
  const ProgramRun result =
      run({"solve", file("pairs"), "--square", "25mm", "-o", file("c.yaml"), "--report", file("r.html")});
  EXPECT_EQ(result.status, 1) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("verdict: do again"));
  EXPECT_THAT(result.out, HasSubstr("is unchanged"));
  EXPECT_EQ(text_of(file("c.yaml")), "what was there before");
  EXPECT_THAT(text_of(file("r.html")), HasSubstr("<h1>do again</h1>"));
}

TEST_F(Program, Check_WithBoard) {
  const StereoRigEstimate k = known_cameras(kImage);
  write_calibration(file("true.yaml"), rectified_pair(k.left, k.right, k.pose));
  ProgramRun result = run({"check", file("true.yaml"), pairs_->path().string(), "--square", "25mm"});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("verdict: good"));

  StereoPose moved = k.pose;  // 0.34°
  moved.rotation = rotation_about({0.006, 0, 0}) * moved.rotation;
  write_calibration(file("moved.yaml"), rectified_pair(k.left, k.right, moved));
  result = run({"check", file("moved.yaml"), pairs_->path().string(), "--board", "9x6"});
  EXPECT_EQ(result.status, 1) << result.out;
  EXPECT_THAT(result.out, HasSubstr("verdict: calibrate again"));

  // Wrong square size: the epipolar error is small, the scale error is not.
  result = run({"check", file("true.yaml"), pairs_->path().string(), "--square", "26mm"});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.out, HasSubstr("too short"));
}

TEST_F(Program, Check_SwappedCamerasRefused) {
  const StereoRigEstimate k = known_cameras(kImage);
  write_calibration(file("true.yaml"), rectified_pair(k.left, k.right, k.pose));
  const ProgramRun result =
      run({"check", file("true.yaml"), "--left", right(0), right(1), "--right", left(0), left(1)});
  EXPECT_EQ(result.status, 2) << result.out;
  EXPECT_THAT(result.err, HasSubstr("check that left and right are not exchanged"));
  EXPECT_THAT(result.out, Not(HasSubstr("verdict")));
}

TEST_F(Program, Board_PrintFoundInTrueSize) {
  if (std::system("command -v pdftoppm >/dev/null") != 0)
    GTEST_SKIP() << "pdftoppm (poppler-utils) is not here";
  ASSERT_EQ(run({"board", "--board", "7x5", "--square", "28mm", "-o", file("b.pdf")}).status, 0);
  const std::string draw = "pdftoppm -r 100 -gray -png -singlefile " + file("b.pdf") + " " + file("b");
  ASSERT_EQ(std::system(draw.c_str()), 0);
  const GrayImage page = read_gray(file("b.png"));
  const Board printed{7, 5, 0.028};
  const auto found = find_board(page.view(), printed, Effort::kThorough);
  ASSERT_TRUE(found.has_value());
  const Corners& c = found->corners;
  const double pixels = std::hypot(c[6].x - c[0].x, c[6].y - c[0].y);
  EXPECT_NEAR(pixels / 100 * 25.4, 168, 0.3);  // six squares, mm
}

}  // namespace
}  // namespace stereod::calib
