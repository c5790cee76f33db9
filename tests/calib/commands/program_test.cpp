// stereo-calibrate as a user runs it, with images and calibrations in files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "calib/board/board_finder.h"
#include "calib/interop/interop.h"
#include "core/geometry/stereo_rectification.h"
#include "daemon/base/file.h"
#include "daemon/config/calibration_file.h"
#include "daemon/imagefile/read_image.h"
#include "daemon/imagefile/write_image.h"
#include "tests/calib/commands/program_fixture.h"
#include "tests/support/board_scene.h"
#include "tests/support/image_files.h"

namespace stereod {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

fs::path datasets() {
  const char* set = std::getenv("STEREO_DATASETS");
  return set != nullptr ? fs::path(set) : fs::path(STEREOD_SOURCE_DIR) / ".." / "shared" / "datasets";
}

TEST_F(Program, SolvesAFolderAndWritesCalibrationAndReport) {
  const ProgramRun result = run({"solve", pairs_->path().string(), "--square", "25mm", "-o", file("c.yaml"),
                                 "--report", file("r.html")});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_THAT(result.out, StartsWith("verdict: good"));
  EXPECT_THAT(result.out, HasSubstr("18 used, each held back once to check with, 0 left out"));
  const Calibration found = read_calibration(file("c.yaml"));
  EXPECT_NEAR(found.left.camera.fx / known_cameras(kImage).left.fx, 1, 0.003);
  EXPECT_EQ(found.quality.pairs_used, 18);

  const std::string page = text_of(file("r.html"));
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  for (const char* word :
       {"<h1>good</h1>", "Where the board has been", "A rectified pair", "How far off depth", "Every pair",
        "left_17.png, right_17.png", "held back", "epipolar", "0.5 m", "10 m"}) {
    EXPECT_THAT(page, HasSubstr(word));
  }
  // Nothing is fetched from anywhere.
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
}

TEST_F(Program, SolvesSideBySidePictures) {
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

TEST_F(Program, BadInputIsOneSentenceAndTouchesNothing) {
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
      {solve({lefts[0]}, {rights[0]}, sane), "there is only one pair of images"},
      {solve({lefts[0]}, rights, sane), "there are 1 left images and 6 right ones"},
      {solve(with(lefts, file("small.png")), rights, sane), "has 64×48 pixels"},
      {solve(with(lefts, file("text.png")), rights, sane), "text.png"},
      {solve(with(lefts, file("none.png")), rights, sane), "none.png"},
      {{"solve", "--square", "25mm", "-o", file("c.yaml")}, "there are no images"},
      {{"solve", directory_.path().string(), "--square", "25mm", "-o", file("c.yaml")},
       "there is no stereo pair"},
      {{"solve", pairs_->path().string(), "--square", "25mm", "-o", file("none/c.yaml")},
       "the directory to write to does not exist"},
      {{"solve", pairs_->path().string(), "--square", "25mm", "--sqare", "1"}, "--sqare"},
      {{"check", file("c.yaml"), pairs_->path().string()}, "allowed a map of keys and values"},
      {{"check", file("none.yaml"), pairs_->path().string()}, "the file does not exist"},
      {{"check", file("good.yaml"), pairs_->path().string(), "--daemon"}, "not both"},
      {{"check", file("good.yaml"), "--daemon", "--config", "x.yaml"}, "say where the images come from"},
      {{"check", file("good.yaml"), "--config", file("none.yaml")}, "the file does not exist"},
      {{"check", file("good.yaml")}, "there are no images"},
      {{"import", "-o", file("c.yaml")}, "--ros, --opencv or --kalibr"},
      {{"import", "--kalibr", file("none.yaml"), "-o", file("c.yaml")}, "the file does not exist"},
      {{"import", "--opencv", left(0), left(1), "-o", file("c.yaml")}, "FileStorage"},
      {{"board", "--paper", "a9"}, "--paper: found 'a9'"},
      {{"board", "-o", file("board.doc")}, "written as .pdf or .svg"},
      {{"capture", "--config", file("none.yaml"), "--square", "25mm"}, "the file does not exist"},
      {{"capture", "--square", "25mm", "-o", file("c.yaml")}, "say where the images come from"},
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

// The board only ever in the middle: solvable, but not to be used.
TEST_F(Program, AResultToDoAgainIsReportedAndReplacesNothing) {
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
  EXPECT_THAT(result.out, HasSubstr("was not touched"));
  EXPECT_EQ(text_of(file("c.yaml")), "what was there before");
  EXPECT_THAT(text_of(file("r.html")), HasSubstr("<h1>do again</h1>"));
}

TEST_F(Program, OpenCvFilesComeBackToTheBit) {
  ASSERT_EQ(run({"solve", pairs_->path().string(), "--square", "25mm", "-o", file("c.yaml")}).status, 0);
  for (const std::string ending : {".yml", ".xml", ".json"}) {
    EXPECT_EQ(run({"export", file("c.yaml"), "--opencv", file("in" + ending), file("ex" + ending)}).status,
              0);
    EXPECT_EQ(
        run({"import", "--opencv", file("in" + ending), file("ex" + ending), "-o", file("d.yaml")}).status,
        0);
    EXPECT_EQ(text_of(file("d.yaml")), text_of(file("c.yaml"))) << ending;
  }
  EXPECT_EQ(run({"export", file("c.yaml"), "--ros", file("l.yaml"), file("r.yaml")}).status, 0);
  EXPECT_EQ(run({"import", "--ros", file("l.yaml"), file("r.yaml"), "-o", file("d.yaml")}).status, 0);
  EXPECT_EQ(text_of(file("d.yaml")), text_of(file("c.yaml")));
}

// As the sample stereo_calib leaves them: squares for a unit, no image size.
TEST_F(Program, ImportsWhatOpenCvsSampleWrites) {
  const Calibration c = [] {
    const StereoRigEstimate k = known_cameras(kImage);
    return rectified_pair(k.left, k.right, k.pose);
  }();
  write_opencv(file("in.yml"), file("ex.yml"), c);
  // Without what only we write; lengths in squares of 25 mm.
  std::string in = text_of(file("in.yml")), ex = text_of(file("ex.yml"));
  in.resize(in.find("image_width"));
  ex.resize(ex.find("baseline_m"));
  write_text_file(file("in.yml"), in);
  write_text_file(file("ex.yml"), ex);
  EXPECT_THAT(run({"import", "--opencv", file("in.yml"), file("ex.yml"), "-o", file("d.yaml")}).err,
              HasSubstr("--image-size"));
  ASSERT_EQ(run({"import", "--opencv", file("in.yml"), file("ex.yml"), "--image-size", "320x240", "--unit",
                 "25mm", "-o", file("d.yaml")})
                .status,
            0);
  const Calibration d = read_calibration(file("d.yaml"));
  EXPECT_EQ(d.left, c.left);
  EXPECT_EQ(d.right, c.right);
  EXPECT_NEAR(d.baseline_m, 0.025 * c.baseline_m, 1e-12);
  // Rectified anew, where the file has only R and T.
  ex.resize(ex.find("R1:"));
  write_text_file(file("ex.yml"), ex);
  ASSERT_EQ(run({"import", "--opencv", file("in.yml"), file("ex.yml"), "--image-size", "320x240", "-o",
                 file("d.yaml")})
                .status,
            0);
  EXPECT_NEAR(read_calibration(file("d.yaml")).baseline_m, c.baseline_m, 1e-12);
}

// Numbers of no camera, in files as OpenCV's sample leaves them: one sentence that names file and matrix.
TEST_F(Program, OpenCvFilesOfNoCameraAreRefused) {
  const StereoRigEstimate k = known_cameras(kImage);
  const Calibration c = rectified_pair(k.left, k.right, k.pose);
  const fs::path in = directory_ / "in.yml", ex = directory_ / "ex.yml";
  write_opencv(in, ex, c);
  std::string intrinsics = text_of(in), extrinsics = text_of(ex);
  intrinsics.resize(intrinsics.find("image_width"));
  extrinsics.resize(extrinsics.find("baseline_m"));
  // The text with number `place` of a matrix replaced.
  const auto spoiled = [](std::string text, const std::string& matrix, int place, const std::string& number) {
    std::size_t at = text.find("data:", text.find(matrix + ":"));
    at = text.find('[', at) + 1;
    for (int i = 0; i < place; ++i) at = text.find(',', at) + 1;
    return text.replace(at, text.find_first_of(",]", at) - at, " " + number);
  };
  const auto complaint = [&](const std::string& intrinsic, const std::string& extrinsic, Size size = kImage) {
    write_text_file(in, intrinsic);
    write_text_file(ex, extrinsic);
    return file_error_of([&] { read_opencv(in, ex, {size}); });
  };
  ASSERT_EQ(complaint(intrinsics, extrinsics), "");
  const auto with_m1 = [&](int place, const std::string& number) {
    return complaint(spoiled(intrinsics, "M1", place, number), extrinsics);
  };
  const std::string focal = "in.yml: the left camera's focal length is ";
  EXPECT_THAT(with_m1(0, "0."), HasSubstr(focal + "0 px; allowed is 1 to 1000000"));
  EXPECT_THAT(with_m1(4, "-280."), HasSubstr(focal + "-280 px"));
  EXPECT_THAT(with_m1(0, "1e300"), HasSubstr(focal + "1e+300 px"));
  EXPECT_THAT(with_m1(0, ".Nan"), HasSubstr("in.yml: M1: allowed are finite numbers"));
  EXPECT_THAT(with_m1(2, ".Inf"), HasSubstr("in.yml: M1: allowed are finite numbers"));
  EXPECT_THAT(with_m1(2, "1e9"), HasSubstr("the left camera's principal point is 1000000000 px"));
  EXPECT_THAT(with_m1(1, "3."), HasSubstr("in.yml: M1: allowed is fx, 0, cx"));
  EXPECT_THAT(complaint(spoiled(intrinsics, "D2", 0, "-20."), extrinsics),
              HasSubstr("in.yml: the right camera's distortion coefficients fold"));
  EXPECT_THAT(complaint(spoiled(intrinsics, "D1", 4, "1e300"), extrinsics),
              HasSubstr("in.yml: the left camera's distortion coefficients fold"));
  EXPECT_THAT(complaint(intrinsics + "image_width: 1e300\nimage_height: 240\n", extrinsics, {}),
              HasSubstr("in.yml: image_width: allowed is a number from 1 to 16384"));
  EXPECT_THAT(complaint(intrinsics + "image_width: 0\nimage_height: 240\n", extrinsics, {}),
              HasSubstr("in.yml: image_width: allowed is a number from 1 to 16384"));
  EXPECT_THAT(complaint(intrinsics + "image_width: wide\nimage_height: 240\n", extrinsics, {}),
              HasSubstr("in.yml: image_width: allowed is a number from 1 to 16384"));

  const auto with_extrinsic = [&](const std::string& matrix, int place, const std::string& number) {
    return complaint(intrinsics, spoiled(extrinsics, matrix, place, number));
  };
  EXPECT_THAT(with_extrinsic("R1", 0, "0.5"), HasSubstr("ex.yml: R1: is no rotation"));
  EXPECT_THAT(with_extrinsic("P1", 0, "0."), HasSubstr("ex.yml: the left projection's focal length is 0 px"));
  EXPECT_THAT(with_extrinsic("P2", 0, "0."),
              HasSubstr("ex.yml: the right projection's focal length is 0 px"));
  EXPECT_THAT(with_extrinsic("P2", 3, "0."), HasSubstr("ex.yml: the baseline is"));
  EXPECT_THAT(with_extrinsic("P2", 3, "-1e300"), HasSubstr("ex.yml: the baseline is"));
  EXPECT_THAT(with_extrinsic("P2", 3, "17."), HasSubstr("left and right are swapped"));
  EXPECT_THAT(with_extrinsic("P2", 7, "-17."), HasSubstr("ex.yml: P2: the cameras stand above each other"));
  EXPECT_THAT(complaint(intrinsics, extrinsics + "baseline_m: 1e300\n"),
              HasSubstr("ex.yml: baseline_m: allowed"));
  EXPECT_THAT(complaint(intrinsics, extrinsics + "baseline_m: 0.06\npairs_used: 1e300\n"),
              HasSubstr("ex.yml: pairs_used: allowed"));

  extrinsics.resize(extrinsics.find("R1:"));  // what is there is rectified anew
  ASSERT_EQ(complaint(intrinsics, extrinsics), "");
  EXPECT_THAT(with_extrinsic("R", 4, "0."), HasSubstr("ex.yml: R: is no rotation"));
  EXPECT_THAT(with_extrinsic("T", 0, "-1e300"), HasSubstr("ex.yml: T: the cameras are 1e+300 m apart"));
  EXPECT_THAT(with_extrinsic("T", 0, "-60."), Not(HasSubstr("T:")));  // 60 m are, if odd, a distance
  EXPECT_THAT(
      complaint(intrinsics, spoiled(spoiled(spoiled(extrinsics, "T", 0, "0."), "T", 1, "0."), "T", 2, "0.")),
      HasSubstr("ex.yml: T: the cameras are 0 m apart"));
}

// A link is written through, as an editor does: what it points to is replaced as a whole, or not at all.
TEST_F(Program, LinksStayWhatTheyPointToIsReplaced) {
  const StereoRigEstimate k = known_cameras(kImage);
  const Calibration c = rectified_pair(k.left, k.right, k.pose);
  write_ros(file("l.yaml"), file("r.yaml"), c);
  fs::create_directories(directory_ / "real/deep");
  fs::create_directory(directory_ / "etc");
  fs::create_symlink("../real/deep/c.yaml", directory_ / "etc/middle.yaml");
  fs::create_symlink("etc/middle.yaml", directory_ / "link.yaml");
  const auto import = [&](const std::string& left, const std::string& output) {
    return run({"import", "--ros", left, file("r.yaml"), "-o", output});
  };
  // There is nothing at its end yet; then there is, and it is kept where the import is bad.
  for (int round = 0; round < 2; ++round) {
    ASSERT_EQ(import(file("l.yaml"), file("link.yaml")).status, 0);
    EXPECT_TRUE(fs::is_symlink(directory_ / "link.yaml"));
    EXPECT_TRUE(fs::is_symlink(directory_ / "etc/middle.yaml"));
    EXPECT_EQ(read_calibration(directory_ / "real/deep/c.yaml").left, c.left);
    EXPECT_EQ(std::distance(fs::directory_iterator(directory_ / "real/deep"), {}),
              1);  // nothing is left beside it
  }
  const std::string before = text_of(directory_ / "real/deep/c.yaml");
  EXPECT_EQ(import(file("r.yaml"), file("link.yaml")).status, 2);
  EXPECT_EQ(text_of(directory_ / "link.yaml"), before);
  EXPECT_TRUE(fs::is_symlink(directory_ / "link.yaml"));
  // Two names of one file are one, by whatever link.
  const ProgramRun twice =
      run({"export", file("link.yaml"), "--ros", file("l2.yaml"), file("real/deep/c.yaml")});
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.err, HasSubstr("is named twice"));

  fs::create_symlink("nowhere/c.yaml", directory_ / "broken.yaml");
  fs::create_symlink("circle.yaml", directory_ / "circle.yaml");
  fs::create_symlink("/dev/null", directory_ / "null.yaml");
  EXPECT_THAT(import(file("l.yaml"), file("broken.yaml")).err,
              HasSubstr("the directory to write to does not exist"));
  EXPECT_THAT(import(file("l.yaml"), file("circle.yaml")).err, HasSubstr("leads in a circle"));
  EXPECT_THAT(import(file("l.yaml"), file("null.yaml")).err, HasSubstr("a device, pipe or socket"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Program, ChecksWithABoard) {
  const StereoRigEstimate k = known_cameras(kImage);
  write_calibration(file("true.yaml"), rectified_pair(k.left, k.right, k.pose));
  ProgramRun result = run({"check", file("true.yaml"), pairs_->path().string(), "--square", "25mm"});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("verdict: good"));

  StereoPose knocked = k.pose;  // a third of a degree
  knocked.rotation = rotation_about({0.006, 0, 0}) * knocked.rotation;
  write_calibration(file("knocked.yaml"), rectified_pair(k.left, k.right, knocked));
  result = run({"check", file("knocked.yaml"), pairs_->path().string(), "--board", "9x6"});
  EXPECT_EQ(result.status, 1) << result.out;
  EXPECT_THAT(result.out, HasSubstr("verdict: calibrate again"));

  // Squares of another size than was said: rows fit, lengths do not.
  result = run({"check", file("true.yaml"), pairs_->path().string(), "--square", "26mm"});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.out, HasSubstr("too short"));
}

TEST_F(Program, ChecksWhichCameraIsWhich) {
  const StereoRigEstimate k = known_cameras(kImage);
  write_calibration(file("true.yaml"), rectified_pair(k.left, k.right, k.pose));
  const ProgramRun result =
      run({"check", file("true.yaml"), "--left", right(0), right(1), "--right", left(0), left(1)});
  EXPECT_EQ(result.status, 2) << result.out;
  EXPECT_THAT(result.err, HasSubstr("are left and right exchanged?"));
  EXPECT_THAT(result.out, Not(HasSubstr("verdict")));
}

TEST_F(Program, ExportDoesNotOverwriteWhatItReadsOrWrote) {
  const StereoRigEstimate k = known_cameras(kImage);
  write_calibration(file("c.yaml"), rectified_pair(k.left, k.right, k.pose));
  const std::string before = text_of(file("c.yaml"));
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"--opencv", file("c.yaml"), file("ex.yaml")},
        std::vector<std::string>{"--ros", file("l.yaml"), file("./c.yaml")},
        std::vector<std::string>{"--ros", file("same.yaml"), file("same.yaml")}}) {
    std::vector<std::string> arguments{"export", file("c.yaml")};
    arguments.insert(arguments.end(), names.begin(), names.end());
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr("is named twice"));
  }
  EXPECT_EQ(text_of(file("c.yaml")), before);
  EXPECT_FALSE(fs::exists(file("l.yaml")));
  const ProgramRun solved = run({"solve", pairs_->path().string(), "--square", "25mm", "-o", file("c.yaml"),
                                 "--report", file("c.yaml")});
  EXPECT_EQ(solved.status, 2);
  EXPECT_EQ(text_of(file("c.yaml")), before);
}

TEST_F(Program, NothingOverwritesWhatItReads) {
  const StereoRigEstimate k = known_cameras(kImage);
  write_calibration(file("c.yaml"), rectified_pair(k.left, k.right, k.pose));
  ASSERT_EQ(run({"export", file("c.yaml"), "--ros", file("l.yaml"), file("r.yaml")}).status, 0);
  fs::copy_file(left(0), file("left_00.png")), fs::copy_file(right(0), file("right_00.png"));
  write_text_file(file("config.yaml"), "cameras:\n  source: synthetic\n  fps: 0\n");
  const auto refused = [&](const std::string& victim, const std::vector<std::string>& arguments) {
    const std::string before = text_of(file(victim));
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(victim + ": is named twice, and would be overwritten"));
    EXPECT_EQ(text_of(file(victim)), before);
  };
  refused("r.yaml", {"import", "--ros", file("l.yaml"), file("r.yaml"), "-o", file("r.yaml")});
  refused("right_00.png", {"solve", directory_.path().string(), "--square", "25mm", "-o", file("c.yaml"),
                           "--report", file("right_00.png")});
  refused("left_00.png", {"solve", "--left", file("left_00.png"), "--right", file("right_00.png"), "--square",
                          "25mm", "-o", file("left_00.png")});
  refused("config.yaml", {"capture", "--config", file("config.yaml"), "--square", "25mm", "--port", "0", "-o",
                          file("config.yaml")});
  const ProgramRun mixed = run({"capture", "--config", file("config.yaml"), "--square", "25mm", "--port", "0",
                                "--keep", directory_.path().string(), "-o", file("new.yaml")});
  EXPECT_EQ(mixed.status, 2);
  EXPECT_THAT(mixed.err, HasSubstr("the directory is not empty"));
}

// In these images the edge of the board passes for a further column of squares.
TEST_F(Program, TheEdgeOfABoardIsNoColumn) {
  const fs::path pictures = datasets() / "rig_stereopi" / "calib";
  if (!fs::exists(pictures)) GTEST_SKIP() << pictures << " is not here";
  std::vector<std::string> arguments{"solve", "--square", "25mm", "-o", file("c.yaml"), "--left"};
  const std::vector<std::string> numbers{"09", "13", "16", "17", "18"};
  for (const std::string& n : numbers) arguments.push_back((pictures / ("left_" + n + ".png")).string());
  arguments.push_back("--right");
  for (const std::string& n : numbers) arguments.push_back((pictures / ("right_" + n + ".png")).string());
  for (const char* board : {"9x6", "auto"}) {
    std::vector<std::string> with_board = arguments;
    with_board.insert(with_board.end(), {"--board", board});
    const ProgramRun result = run(with_board);
    EXPECT_THAT(result.out, HasSubstr("9×6")) << board << ": " << result.err;
    EXPECT_NE(result.status, 2) << board << ": " << result.err;
  }
}

// One of them would pass for a larger board, and is there twice.
TEST_F(Program, APictureGivenTwiceDecidesNothing) {
  const fs::path pictures = datasets() / "calib_sourishg_webcams" / "calib";
  if (!fs::exists(pictures)) GTEST_SKIP() << pictures << " is not here";
  std::vector<std::string> arguments{"solve", "--square", "25mm", "-o", file("c.yaml")};
  for (const char* side : {"left", "right"}) {
    arguments.push_back(std::string("--") + side);
    for (const char* number : {"24", "24", "03", "07", "11", "15", "19"}) {
      arguments.push_back((pictures / (std::string(side) + "_" + number + ".jpg")).string());
    }
  }
  for (const char* board : {"9x6", "auto"}) {
    std::vector<std::string> with_board = arguments;
    with_board.insert(with_board.end(), {"--board", board});
    const ProgramRun result = run(with_board);
    EXPECT_THAT(result.out, HasSubstr("9×6")) << board << ": " << result.err;
    EXPECT_THAT(result.out, HasSubstr("shows the same two images as left_24.jpg"))
        << board << ": " << result.err;
  }
}

TEST_F(Program, BoardsAreFoundAgainInWhatIsPrinted) {
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
}  // namespace stereod
