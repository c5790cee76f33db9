// SPDX-License-Identifier: BSD-3-Clause
// Which image files form a recording, and which are refused.
#include "daemon/capture/replay/recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

Bytes pgm_image(int value, Size size = {4, 3}) {
  const std::string header =
      "P5 " + std::to_string(size.width) + " " + std::to_string(size.height) + " 255\n";
  return make_raw_pnm(header, std::vector<int>(static_cast<std::size_t>(size.width * size.height), value),
                      false);
}

class RecordingTest : public testing::Test {
 protected:
  void add(const std::string& name, int value, Size size = {4, 3}) {
    std::filesystem::create_directories((directory_ / name).parent_path());
    write_bytes(directory_ / name, pgm_image(value, size));
  }
  /// Adds pairs numbered from 0 whose pixels are 10, 11, … and 110, 111, …
  void add_pairs(int count) {
    for (int i = 0; i < count; ++i) {
      add("left_" + std::to_string(i) + ".pgm", 10 + i);
      add("right_" + std::to_string(i) + ".pgm", 110 + i);
    }
  }
  /// Returns the first pixels of all left and right images, in the order of replay.
  std::vector<std::pair<int, int>> recorded() const {
    std::vector<std::pair<int, int>> values;
    const Recording recording(directory_.path());
    for (const RecordedPair& pair : recording.pairs()) {
      values.emplace_back(pair.left.at(0, 0), pair.right.at(0, 0));
    }
    return values;
  }
  std::string refusal() const {
    return file_error_of([&] { Recording recording(directory_.path()); });
  }
  std::string in_directory(const std::string& name) const { return (directory_ / name).string(); }

  TemporaryDirectory directory_;
};

TEST_F(RecordingTest, Numbers_SortedByValue) {
  for (const int i : {10, 9, 100, 2}) {
    add("left_" + std::to_string(i) + ".pgm", i);
    add("right_" + std::to_string(i) + ".pgm", i + 100);
  }
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{2, 102}, {9, 109}, {10, 110}, {100, 200}}));
}

TEST_F(RecordingTest, NameVariants_Found) {
  const std::vector<std::pair<std::string, std::string>> names{{"left_00.pgm", "right_00.pgm"},
                                                               {"left01.ppm", "right01.pgm"},
                                                               {"L2.pgm", "R2.pgm"},
                                                               {"LEFT-3.PGM", "Right-003.pgm"},
                                                               {"l_00000000000000000000004.pgm", "r4.pgm"}};
  int value = 0;
  for (const auto& [left, right] : names) {
    add(left, value);
    add(right, 100 + value++);
  }
  add("disparity_00.pgm", 77);  // ignored
  write_bytes(directory_ / "left_99.txt", bytes_of("nor does this"));
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{0, 100}, {1, 101}, {2, 102}, {3, 103}, {4, 104}}));
}

TEST_F(RecordingTest, NoNumber_OnlyPair) {
  add("left.pgm", 1);
  add("right.pgm", 2);
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{1, 2}}));
}

TEST_F(RecordingTest, LeftRightDirectories_Found) {
  add("left/0002.pgm", 2);
  add("left/0001.pgm", 1);
  add("right/frame_2.pgm", 102);
  add("right/frame_1.pgm", 101);
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{1, 101}, {2, 102}}));
}

TEST_F(RecordingTest, OneLetterDirectories_Found) {
  add("L/7.pgm", 7);
  add("R/7.pgm", 107);
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{7, 107}}));
}

TEST_F(RecordingTest, PartnerMissing_Named) {
  add_pairs(2);
  add("left_5.pgm", 5);
  EXPECT_EQ(refusal(), in_directory("left_5.pgm") + ": no right image with the same number");
  std::filesystem::remove(directory_ / "left_5.pgm");
  std::filesystem::remove(directory_ / "left_1.pgm");
  EXPECT_EQ(refusal(), in_directory("right_1.pgm") + ": no left image with the same number");
}

TEST_F(RecordingTest, NumberTwice_Named) {
  add_pairs(2);
  add("left_01.pgm", 5);
  EXPECT_EQ(refusal(),
            in_directory("left_1.pgm") + ": same number as left_01.pgm; each pair needs its own number");
}

TEST_F(RecordingTest, NoPairs_RemedyNamed) {
  add("image.pgm", 1);
  EXPECT_EQ(refusal(),
            directory_.path().string() +
                ": no stereo pair found; files like left_00.png and right_00.png, or directories left "
                "and right with numbered images, are needed");
  EXPECT_EQ(file_error_of([&] { Recording recording(directory_ / "none"); }),
            in_directory("none") + ": no such directory");
  EXPECT_EQ(file_error_of([&] { Recording recording(directory_ / "image.pgm"); }),
            in_directory("image.pgm") + ": not a directory; a directory of numbered pairs is needed");
}

TEST_F(RecordingTest, OtherSize_Named) {
  add_pairs(2);
  add("right_0.pgm", 1, {5, 3});
  EXPECT_EQ(refusal(),
            in_directory("right_0.pgm") +
                ": has 5×3 pixels, but left_0.pgm has 4×3; all images of a recording must have one size");
  add("right_0.pgm", 1);
  add("left_1.pgm", 1, {4, 8});
  EXPECT_EQ(refusal(),
            in_directory("left_1.pgm") +
                ": has 4×8 pixels, but left_0.pgm has 4×3; all images of a recording must have one size");
  EXPECT_EQ(file_error_of([&] { Recording recording(directory_ / "left_0.pgm", directory_ / "left_1.pgm"); }),
            in_directory("left_1.pgm") +
                ": has 4×8 pixels, but left_0.pgm has 4×3; all images of a recording must have one size");
}

TEST_F(RecordingTest, Unreadable_Named) {
  add_pairs(2);
  write_bytes(directory_ / "right_1.pgm", bytes_of("P5 4 3 255\nabc"));
  EXPECT_EQ(refusal(),
            in_directory("right_1.pgm") + ": the PGM file is truncated; it ends before its image does");
}

TEST_F(RecordingTest, OverOneGiB_Refused) {
  // 33 pairs of 4096² pixels; the size is checked after the first pair is read.
  const Bytes large = make_png(PngKind::kGray, 1, false, {4096, 4096}, std::vector<int>(4096 * 4096));
  write_bytes(directory_ / "large.png", large);
  for (int i = 0; i < 33; ++i) {
    std::filesystem::create_hard_link(directory_ / "large.png",
                                      directory_ / ("left" + std::to_string(i) + ".png"));
    std::filesystem::create_hard_link(directory_ / "large.png",
                                      directory_ / ("right" + std::to_string(i) + ".png"));
  }
  EXPECT_EQ(refusal(), directory_.path().string() +
                           ": 33 pairs of 4096×4096 pixels exceed the limit of 1 GiB; remove some");
}

}  // namespace
}  // namespace stereod
