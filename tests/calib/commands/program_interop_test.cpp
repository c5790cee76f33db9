// SPDX-License-Identifier: BSD-3-Clause
// stereo-calibrate as a process: import and export.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "calib/interop/interop.h"
#include "core/geometry/stereo_rectification.h"
#include "daemon/base/file.h"
#include "daemon/config/calibration_file.h"
#include "tests/calib/commands/program_fixture.h"
#include "tests/support/board_scene.h"
#include "tests/support/image_files.h"

namespace stereod::calib {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

TEST_F(Program, Export_ImportsBitExact) {
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

// Files as OpenCV's sample stereo_calib writes them: lengths in squares, no image size.
TEST_F(Program, Import_OpenCvSampleFiles) {
  const Calibration c = [] {
    const StereoRigEstimate k = known_cameras(kImage);
    return rectified_pair(k.left, k.right, k.pose);
  }();
  write_opencv(file("in.yml"), file("ex.yml"), c);
  // Without stereod's extra nodes; lengths in squares of 25 mm.
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
  // The rectification is computed if the file has only R and T.
  ex.resize(ex.find("R1:"));
  write_text_file(file("ex.yml"), ex);
  ASSERT_EQ(run({"import", "--opencv", file("in.yml"), file("ex.yml"), "--image-size", "320x240", "-o",
                 file("d.yaml")})
                .status,
            0);
  EXPECT_NEAR(read_calibration(file("d.yaml")).baseline_m, c.baseline_m, 1e-12);
}

// Implausible numbers are refused with one sentence that names file and matrix.
TEST_F(Program, Import_ImplausibleOpenCvRefused) {
  const StereoRigEstimate k = known_cameras(kImage);
  const Calibration c = rectified_pair(k.left, k.right, k.pose);
  const fs::path in = directory_ / "in.yml", ex = directory_ / "ex.yml";
  write_opencv(in, ex, c);
  std::string intrinsics = text_of(in), extrinsics = text_of(ex);
  intrinsics.resize(intrinsics.find("image_width"));
  extrinsics.resize(extrinsics.find("baseline_m"));
  // Returns the text with element `place` of a matrix replaced.
  const auto spoiled = [](std::string text, const std::string& matrix, int place, const std::string& number) {
    std::size_t at = text.find("data:", text.find(matrix + ":"));
    at = text.find('[', at) + 1;
    for (int i = 0; i < place; ++i) at = text.find(',', at) + 1;
    return text.replace(at, text.find_first_of(",]", at) - at, " " + number);
  };
  const auto problem_of = [&](const std::string& intrinsic, const std::string& extrinsic,
                              Size size = kImage) {
    write_text_file(in, intrinsic);
    write_text_file(ex, extrinsic);
    return file_error_of([&] { read_opencv(in, ex, {size}); });
  };
  ASSERT_EQ(problem_of(intrinsics, extrinsics), "");
  const auto with_m1 = [&](int place, const std::string& number) {
    return problem_of(spoiled(intrinsics, "M1", place, number), extrinsics);
  };
  const std::string focal = "in.yml: the left camera's focal length is ";
  EXPECT_THAT(with_m1(0, "0."), HasSubstr(focal + "0 px; allowed is 1 to 1000000"));
  EXPECT_THAT(with_m1(4, "-280."), HasSubstr(focal + "-280 px"));
  EXPECT_THAT(with_m1(0, "1e300"), HasSubstr(focal + "1e+300 px"));
  EXPECT_THAT(with_m1(0, ".Nan"), HasSubstr("in.yml: M1: allowed are finite numbers"));
  EXPECT_THAT(with_m1(2, ".Inf"), HasSubstr("in.yml: M1: allowed are finite numbers"));
  EXPECT_THAT(with_m1(2, "1e9"), HasSubstr("the left camera's principal point is 1000000000 px"));
  EXPECT_THAT(with_m1(1, "3."), HasSubstr("in.yml: M1: allowed is fx, 0, cx"));
  EXPECT_THAT(problem_of(spoiled(intrinsics, "D2", 0, "-20."), extrinsics),
              HasSubstr("in.yml: the right camera's distortion coefficients fold"));
  EXPECT_THAT(problem_of(spoiled(intrinsics, "D1", 4, "1e300"), extrinsics),
              HasSubstr("in.yml: the left camera's distortion coefficients fold"));
  EXPECT_THAT(problem_of(intrinsics + "image_width: 1e300\nimage_height: 240\n", extrinsics, {}),
              HasSubstr("in.yml: image_width: allowed is a number from 1 to 16384"));
  EXPECT_THAT(problem_of(intrinsics + "image_width: 0\nimage_height: 240\n", extrinsics, {}),
              HasSubstr("in.yml: image_width: allowed is a number from 1 to 16384"));
  EXPECT_THAT(problem_of(intrinsics + "image_width: wide\nimage_height: 240\n", extrinsics, {}),
              HasSubstr("in.yml: image_width: allowed is a number from 1 to 16384"));

  const auto with_extrinsic = [&](const std::string& matrix, int place, const std::string& number) {
    return problem_of(intrinsics, spoiled(extrinsics, matrix, place, number));
  };
  EXPECT_THAT(with_extrinsic("R1", 0, "0.5"), HasSubstr("ex.yml: R1: not a rotation"));
  EXPECT_THAT(with_extrinsic("P1", 0, "0."), HasSubstr("ex.yml: the left projection's focal length is 0 px"));
  EXPECT_THAT(with_extrinsic("P2", 0, "0."),
              HasSubstr("ex.yml: the right projection's focal length is 0 px"));
  EXPECT_THAT(with_extrinsic("P2", 3, "0."), HasSubstr("ex.yml: the baseline is"));
  EXPECT_THAT(with_extrinsic("P2", 3, "-1e300"), HasSubstr("ex.yml: the baseline is"));
  EXPECT_THAT(with_extrinsic("P2", 3, "17."), HasSubstr("left and right are swapped"));
  EXPECT_THAT(with_extrinsic("P2", 7, "-17."),
              HasSubstr("ex.yml: P2: the cameras are mounted above each other"));
  EXPECT_THAT(problem_of(intrinsics, extrinsics + "baseline_m: 1e300\n"),
              HasSubstr("ex.yml: baseline_m: allowed"));
  EXPECT_THAT(problem_of(intrinsics, extrinsics + "baseline_m: 0.06\npairs_used: 1e300\n"),
              HasSubstr("ex.yml: pairs_used: allowed"));

  extrinsics.resize(extrinsics.find("R1:"));  // now read_opencv() rectifies
  ASSERT_EQ(problem_of(intrinsics, extrinsics), "");
  EXPECT_THAT(with_extrinsic("R", 4, "0."), HasSubstr("ex.yml: R: not a rotation"));
  EXPECT_THAT(with_extrinsic("T", 0, "-1e300"), HasSubstr("ex.yml: T: the cameras are 1e+300 m apart"));
  EXPECT_THAT(with_extrinsic("T", 0, "-60."), Not(HasSubstr("T:")));  // 60 m is within the range
  EXPECT_THAT(
      problem_of(intrinsics, spoiled(spoiled(spoiled(extrinsics, "T", 0, "0."), "T", 1, "0."), "T", 2, "0.")),
      HasSubstr("ex.yml: T: the cameras are 0 m apart"));
}

}  // namespace
}  // namespace stereod::calib
