// SPDX-License-Identifier: BSD-3-Clause
// Fixture of tests that run stereo-calibrate as a process.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "calib/board/board.h"
#include "daemon/imagefile/write_image.h"
#include "tests/support/board_scene.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_directory.h"

namespace stereod::calib {

inline const Board kBoard{9, 6, 0.025};
inline constexpr Size kImage{320, 240};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline std::string two_digits(std::size_t number) {
  return (number < 10 ? "0" : "") + std::to_string(number) + ".png";
}

// Renders pairs of known_cameras() into a directory, once per test suite.
class Program : public testing::Test {
 public:
  static void SetUpTestSuite() {
    pairs_ = new TemporaryDirectory;
    const BoardScene scene(known_cameras(kImage), kBoard);
    std::size_t number = 0;
    for (const BoardPose& pose : varied_poses(kBoard, 18)) {
      const ImagePair pair = scene.render(pose, number);
      write_png(*pairs_ / ("left_" + two_digits(number)), pair.left.view());
      write_png(*pairs_ / ("right_" + two_digits(number)), pair.right.view());
      ++number;
    }
  }
  static void TearDownTestSuite() { delete pairs_; }

 protected:
  ProgramRun run(const std::vector<std::string>& arguments) const {
    return run_program(std::filesystem::path(STEREOD_BIN_DIR) / "stereo-calibrate", arguments,
                       directory_.path());
  }
  std::string file(const std::string& name) const { return (directory_ / name).string(); }
  static std::string left(std::size_t number) { return (*pairs_ / ("left_" + two_digits(number))).string(); }
  static std::string right(std::size_t number) {
    return (*pairs_ / ("right_" + two_digits(number))).string();
  }

  inline static TemporaryDirectory* pairs_ = nullptr;
  TemporaryDirectory directory_;
};

}  // namespace stereod::calib
