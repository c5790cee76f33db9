// SPDX-License-Identifier: BSD-3-Clause
// stereo-calibrate as a process, with images of public sets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/calib/commands/program_fixture.h"
#include "tests/calib/datasets.h"

namespace stereod::calib {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// In these images the board's edge looks like a further column of squares.
TEST_F(Program, Solve_BoardEdgeNotAColumn) {
  const fs::path images = datasets() / "rig_stereopi" / "calib";
  if (!fs::exists(images)) GTEST_SKIP() << images << " is missing";
  std::vector<std::string> arguments{"solve", "--square", "25mm", "-o", file("c.yaml"), "--left"};
  const std::vector<std::string> numbers{"09", "13", "16", "17", "18"};
  for (const std::string& n : numbers) arguments.push_back((images / ("left_" + n + ".png")).string());
  arguments.push_back("--right");
  for (const std::string& n : numbers) arguments.push_back((images / ("right_" + n + ".png")).string());
  for (const char* board : {"9x6", "auto"}) {
    std::vector<std::string> with_board = arguments;
    with_board.insert(with_board.end(), {"--board", board});
    const ProgramRun result = run(with_board);
    EXPECT_THAT(result.out, HasSubstr("9×6")) << board << ": " << result.err;
    EXPECT_NE(result.status, 2) << board << ": " << result.err;
  }
}

// One image looks like it shows a larger board, and is given twice.
TEST_F(Program, Solve_RepeatedImageIgnored) {
  const fs::path images = datasets() / "calib_sourishg_webcams" / "calib";
  if (!fs::exists(images)) GTEST_SKIP() << images << " is missing";
  std::vector<std::string> arguments{"solve", "--square", "25mm", "-o", file("c.yaml")};
  for (const char* side : {"left", "right"}) {
    arguments.push_back(std::string("--") + side);
    for (const char* number : {"24", "24", "03", "07", "11", "15", "19"}) {
      arguments.push_back((images / (std::string(side) + "_" + number + ".jpg")).string());
    }
  }
  for (const char* board : {"9x6", "auto"}) {
    std::vector<std::string> with_board = arguments;
    with_board.insert(with_board.end(), {"--board", board});
    const ProgramRun result = run(with_board);
    EXPECT_THAT(result.out, HasSubstr("9×6")) << board << ": " << result.err;
    EXPECT_THAT(result.out, HasSubstr("has the same two images as left_24.jpg"))
        << board << ": " << result.err;
  }
}

}  // namespace
}  // namespace stereod::calib
