// SPDX-License-Identifier: BSD-3-Clause
// stereo-calibrate as a process with live images: from cameras, and over LCM from the daemon.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/stereo_rectification.h"
#include "daemon/base/file.h"
#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/config/calibration_file.h"
#include "daemon/imagefile/write_image.h"
#include "tests/calib/commands/program_fixture.h"
#include "tests/support/board_scene.h"
#include "tests/support/network.h"
#include "tests/support/recorded_pairs.h"
#include "tests/support/run_program.h"

namespace stereod::calib {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Compares with the parameters of the synthetic scene.
void expect_found(const Calibration& found, const Calibration& truth) {
  EXPECT_NEAR(found.left.camera.fx / truth.left.camera.fx, 1, 0.003);
  EXPECT_NEAR(found.left.camera.fy / truth.left.camera.fy, 1, 0.003);
  EXPECT_NEAR(found.right.camera.fx / truth.right.camera.fx, 1, 0.003);
  EXPECT_NEAR(found.right.camera.fy / truth.right.camera.fy, 1, 0.003);
  EXPECT_NEAR(found.baseline_m / truth.baseline_m, 1, 0.003);
}

// The synthetic cameras see a board that moves and rests in turn.
TEST_F(Program, Capture_GuidesAndSolves) {
  write_text_file(directory_ / "config.yaml",
                  "cameras:\n  source: synthetic\n  fps: 0\n  synthetic: {scene: board}\n");
  const ProgramRun result =
      run({"capture", "--config", file("config.yaml"), "--board", "9x6", "--square", "25mm", "--port", "0",
           "--keep", file("kept"), "-o", file("c.yaml"), "--report", file("r.html")});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  for (const char* words : {"show the whole board to both cameras", "hold still", "tilt the board",
                            "left no ", "left yes right yes"}) {
    EXPECT_THAT(result.err, HasSubstr(words));
  }
  EXPECT_THAT(result.out, HasSubstr("pairs taken\nverdict: good"));
  expect_found(read_calibration(file("c.yaml")), SyntheticScene().calibration());
  EXPECT_TRUE(fs::exists(directory_ / "kept/left_14.png"));
  EXPECT_TRUE(fs::exists(directory_ / "r.html"));
}

TEST_F(Program, Capture_NoBoardRefused) {
  write_text_file(directory_ / "config.yaml",
                  "cameras:\n  source: replay\n  fps: 0\n  replay:\n    left: " + file("g.png") +
                      "\n    right: " + file("g.png") + "\n    loop: false\n");
  write_png(directory_ / "g.png", GrayImage(kImage).view());
  const ProgramRun result = run(
      {"capture", "--config", file("config.yaml"), "--square", "25mm", "--port", "0", "-o", file("c.yaml")});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("at least 5 are needed"));
  EXPECT_FALSE(fs::exists(directory_ / "c.yaml"));
}

// The same with the raw images of a running daemon.
TEST_F(Program, Capture_FromDaemon) {
  if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
  write_text_file(directory_ / "config.yaml",
                  "cameras:\n  source: synthetic\n  fps: 10\n  synthetic: {scene: board}\n"
                  "lcm:\n  prefix: BOARDS\n  raw_images: true\n  raw_images_per_second: 10\n");
  fs::create_directory(directory_ / "daemon");
  ChildProgram daemon(fs::path(STEREOD_BIN_DIR) / "stereod", {"--config", file("config.yaml")},
                      directory_ / "daemon");
  const ProgramRun result = run(
      {"capture", "--daemon", "--prefix", "BOARDS", "--square", "25mm", "--port", "0", "-o", file("c.yaml")});
  daemon.send(SIGTERM);
  EXPECT_EQ(daemon.wait().status, 0);
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  expect_found(read_calibration(file("c.yaml")), SyntheticScene().calibration());
}

// The daemon plays a recording with a board, then a scene without one; with the right calibration, then with a moved
// camera.
TEST_F(Program, Check_FromDaemon) {
  if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
  const StereoRigEstimate k = known_cameras(kImage);
  write_calibration(file("true.yaml"), rectified_pair(k.left, k.right, k.pose));
  StereoPose moved = k.pose;  // 0.5°
  moved.rotation = rotation_about({0.009, 0, 0}) * moved.rotation;
  write_calibration(file("moved.yaml"), rectified_pair(k.left, k.right, moved));
  fs::create_directory(directory_ / "boards");
  for (std::size_t pose = 0; pose < 16; ++pose) {
    fs::create_symlink(left(pose), directory_ / ("boards/left_" + std::to_string(pose) + ".png"));
    fs::create_symlink(right(pose), directory_ / ("boards/right_" + std::to_string(pose) + ".png"));
  }
  write_recorded_pairs(directory_.path(), kImage, 6);  // a scene, and the calibration.yaml of its cameras
  Calibration scene = read_calibration(file("calibration.yaml"));
  scene.right.rotation = rotation_about({0.012, 0, 0}) * scene.right.rotation;
  write_calibration(file("scene_moved.yaml"), scene);
  fs::create_directory(directory_ / "scene");
  for (int i = 0; i < 6; ++i) {
    for (const fs::path& image :
         {recorded_left(directory_.path(), i), recorded_right(directory_.path(), i)}) {
      fs::rename(image, directory_ / "scene" / image.filename());
    }
  }

  struct Case {
    const char *play, *calibration;
    std::vector<std::string> more;
    int status;
    const char* words;
  };
  const Case cases[] = {
      {"boards", "true.yaml", {"--square", "25mm"}, 0, "verdict: good"},
      {"boards", "moved.yaml", {"--board", "9x6"}, 1, "verdict: calibrate again"},
      {"scene", "calibration.yaml", {"--board", "none"}, 0, "verdict: good"},
      {"scene", "scene_moved.yaml", {}, 1, "verdict: calibrate again"},
  };
  for (const Case& each : cases) {
    const std::string config = file(std::string(each.play) + ".yaml");
    write_text_file(
        config, "cameras:\n  source: replay\n  fps: 10\n  replay:\n    directory: " + std::string(each.play) +
                    "\nlcm:\n  prefix: CHECKED\n  raw_images: true\n  raw_images_per_second: 10\n");
    fs::create_directories(directory_ / "daemon");
    ChildProgram daemon(fs::path(STEREOD_BIN_DIR) / "stereod", {"--config", config}, directory_ / "daemon");
    std::vector<std::string> arguments{
        "check", file(each.calibration), "--daemon", "--prefix", "CHECKED", "--pairs", "6"};
    arguments.insert(arguments.end(), each.more.begin(), each.more.end());
    const ProgramRun result = run(arguments);
    daemon.send(SIGTERM);
    EXPECT_EQ(daemon.wait().status, 0);
    EXPECT_EQ(result.status, each.status) << each.calibration << '\n' << result.out << result.err;
    EXPECT_THAT(result.out, HasSubstr(each.words));
    EXPECT_THAT(result.out, HasSubstr("epipolar error: "));
    EXPECT_THAT(result.out, HasSubstr("expected depth error"));
  }
}

TEST_F(Program, Check_FromConfig) {
  write_recorded_pairs(directory_.path(), kImage, 3);
  write_text_file(directory_ / "config.yaml",
                  "cameras:\n  source: replay\n  fps: 0\n  replay:\n    directory: .\n    loop: false\n");
  const ProgramRun result =
      run({"check", file("calibration.yaml"), "--config", file("config.yaml"), "--board", "none"});
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 pairs"));
  EXPECT_THAT(result.out, HasSubstr("verdict: good"));
}

}  // namespace
}  // namespace stereod::calib
