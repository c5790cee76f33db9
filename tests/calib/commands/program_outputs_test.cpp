// SPDX-License-Identifier: BSD-3-Clause
// stereo-calibrate as a process: which files it replaces and which it refuses to.
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

namespace stereod::calib {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Writing to a symbolic link replaces its target atomically.
TEST_F(Program, OutputLink_TargetReplaced) {
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
  // Round 0 creates the target, round 1 replaces it.
  for (int round = 0; round < 2; ++round) {
    ASSERT_EQ(import(file("l.yaml"), file("link.yaml")).status, 0);
    EXPECT_TRUE(fs::is_symlink(directory_ / "link.yaml"));
    EXPECT_TRUE(fs::is_symlink(directory_ / "etc/middle.yaml"));
    EXPECT_EQ(read_calibration(directory_ / "real/deep/c.yaml").left, c.left);
    EXPECT_EQ(std::distance(fs::directory_iterator(directory_ / "real/deep"), {}),
              1);  // no temporary file remains
  }
  const std::string before = text_of(directory_ / "real/deep/c.yaml");
  EXPECT_EQ(import(file("r.yaml"), file("link.yaml")).status, 2);
  EXPECT_EQ(text_of(directory_ / "link.yaml"), before);
  EXPECT_TRUE(fs::is_symlink(directory_ / "link.yaml"));
  // Two names of one file are recognized through links.
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
  EXPECT_THAT(import(file("l.yaml"), file("null.yaml")).err, HasSubstr("is a device, pipe or socket"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Program, Export_NamedTwiceRefused) {
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

TEST_F(Program, Output_InputFileRefused) {
  const StereoRigEstimate k = known_cameras(kImage);
  write_calibration(file("c.yaml"), rectified_pair(k.left, k.right, k.pose));
  ASSERT_EQ(run({"export", file("c.yaml"), "--ros", file("l.yaml"), file("r.yaml")}).status, 0);
  fs::copy_file(left(0), file("left_00.png")), fs::copy_file(right(0), file("right_00.png"));
  write_text_file(file("config.yaml"), "cameras:\n  source: synthetic\n  fps: 0\n");
  const auto refused = [&](const std::string& victim, const std::vector<std::string>& arguments) {
    const std::string before = text_of(file(victim));
    const ProgramRun result = run(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(victim + ": is named twice and would be overwritten"));
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

}  // namespace
}  // namespace stereod::calib
