#include "daemon/capture/replay/replay_source.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/capture/replay/recording.h"
#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLong = std::chrono::hours(1);  // never waited for unless something is broken
constexpr milliseconds kNone{0};

Bytes picture(int value, Size size = {4, 3}) {
  const std::string header =
      "P5 " + std::to_string(size.width) + " " + std::to_string(size.height) + " 255\n";
  return make_raw_pnm(header, std::vector<int>(static_cast<std::size_t>(size.width * size.height), value),
                      false);
}

class ReplaySourceTest : public testing::Test {
 protected:
  void add(const std::string& name, int value, Size size = {4, 3}) {
    std::filesystem::create_directories((directory_ / name).parent_path());
    write_bytes(directory_ / name, picture(value, size));
  }
  /// Pairs numbered from 0 whose pixels are 10, 11, … and 110, 111, …
  void add_pairs(int count) {
    for (int i = 0; i < count; ++i) {
      add("left_" + std::to_string(i) + ".pgm", 10 + i);
      add("right_" + std::to_string(i) + ".pgm", 110 + i);
    }
  }
  /// First pixels of all left and right images in the order in which they are replayed.
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

TEST_F(ReplaySourceTest, PlaysEachPairOnceAndFinishes) {
  add_pairs(3);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 0, .loop = false});
  EXPECT_EQ(sources.left->state(), SourceState::kWaiting);
  EXPECT_EQ(sources.left->frame_size(), (Size{4, 3}));
  for (int i = 0; i < 3; ++i) {
    const FrameLease left = sources.left->next(kLong);
    const FrameLease right = sources.right->next(kLong);
    ASSERT_TRUE(left && right) << i;
    EXPECT_EQ(left.frame().luma.data[0], 10 + i);
    EXPECT_EQ(right.frame().luma.data[0], 110 + i);
    EXPECT_EQ(left.frame().sequence, static_cast<std::uint32_t>(i));
    EXPECT_EQ(right.frame().sequence, static_cast<std::uint32_t>(i));
    EXPECT_EQ(left.frame().captured_ns, right.frame().captured_ns);
    EXPECT_EQ(sources.left->state(), SourceState::kStreaming);
  }
  for (FrameSource* source : {sources.left.get(), sources.right.get(), sources.left.get()}) {
    EXPECT_FALSE(source->next(kLong));
    EXPECT_EQ(source->state(), SourceState::kFinished);
  }
}

TEST_F(ReplaySourceTest, LoopsAndGoesOnCounting) {
  add_pairs(3);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 0, .loop = true});
  std::int64_t last_captured = std::numeric_limits<std::int64_t>::min();
  for (int i = 0; i < 8; ++i) {
    const FrameLease left = sources.left->next(kLong);
    const FrameLease right = sources.right->next(kLong);
    ASSERT_TRUE(left && right) << i;
    EXPECT_EQ(left.frame().luma.data[0], 10 + i % 3);
    EXPECT_EQ(right.frame().luma.data[0], 110 + i % 3);
    EXPECT_EQ(left.frame().sequence, static_cast<std::uint32_t>(i));
    EXPECT_GE(left.frame().captured_ns, last_captured);
    last_captured = left.frame().captured_ns;
  }
}

TEST_F(ReplaySourceTest, LendsWholePictures) {
  write_bytes(directory_ / "l0.pgm", make_raw_pnm("P5 3 2 255\n", {1, 2, 3, 4, 5, 6}, false));
  add("r0.pgm", 9, {3, 2});
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 0});
  const FrameLease lease = sources.left->next(kLong);
  const LumaView& luma = lease.frame().luma;
  EXPECT_EQ(luma.size, (Size{3, 2}));
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      EXPECT_EQ(luma.data[y * luma.row_stride + x * luma.pixel_stride], 1 + 3 * y + x);
    }
  }
}

TEST_F(ReplaySourceTest, AsFastAsPossibleWaitsForTheFrameToComeBack) {
  add_pairs(2);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 0});
  FrameLease left = sources.left->next(kLong);
  FrameLease right = sources.right->next(kLong);
  EXPECT_FALSE(sources.left->next(kNone)) << "the first one is still on loan";
  EXPECT_EQ(sources.left->state(), SourceState::kStreaming);
  left.end();
  left = sources.left->next(kLong);
  EXPECT_EQ(left.frame().sequence, 1U);
}

TEST_F(ReplaySourceTest, PacedFramesKeepTheirDistance) {
  add_pairs(3);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 500, .loop = true});
  // Whoever is slow misses frames, so only what belongs to a number is checked, not which numbers come.
  std::vector<Frame> frames;
  for (int i = 0; i < 20; ++i) {
    FrameSource& source = i % 2 == 0 ? *sources.left : *sources.right;
    const FrameLease lease = source.next(kLong);
    ASSERT_TRUE(lease);
    frames.push_back(lease.frame());
    EXPECT_EQ(lease.frame().luma.data[0],
              (i % 2 == 0 ? 10 : 110) + static_cast<int>(lease.frame().sequence % 3));
  }
  for (const Frame& frame : frames) {
    const auto numbers = static_cast<std::int64_t>(frame.sequence) - frames[0].sequence;
    EXPECT_EQ(frame.captured_ns - frames[0].captured_ns, numbers * 2'000'000);
  }
}

TEST_F(ReplaySourceTest, PacedReplayFinishesToo) {
  add_pairs(2);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 1000, .loop = false});
  for (FrameSource* source : {sources.left.get(), sources.right.get()}) {
    int frames = 0;
    while (source->state() != SourceState::kFinished) {
      if (source->next(kLong)) ++frames;
    }
    EXPECT_LE(frames, 2);
  }
}

TEST_F(ReplaySourceTest, OneSideThatFinishedDoesNotHoldTheOther) {
  add_pairs(1);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 0, .loop = false});
  sources.left->next(kLong).end();
  sources.right->next(kLong).end();
  EXPECT_FALSE(sources.left->next(kLong));
  EXPECT_FALSE(sources.right->next(kLong));
  EXPECT_EQ(sources.right->state(), SourceState::kFinished);
}

TEST_F(ReplaySourceTest, StopEndsAWait) {
  add_pairs(1);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 0});
  const FrameLease on_loan = sources.left->next(kLong);
  std::thread waiting([&] { EXPECT_FALSE(sources.left->next(kLong)); });
  sources.left->stop();
  waiting.join();
  EXPECT_FALSE(sources.left->next(kLong));
}

TEST_F(ReplaySourceTest, OneSourceMayLiveLonger) {
  add_pairs(1);
  ReplaySources sources = open_replay(directory_.path(), {.fps = 0});
  sources.left->stop();
  sources.left.reset();
  const FrameLease lease = sources.right->next(kLong);
  EXPECT_EQ(lease.frame().luma.data[0], 110);
}

TEST_F(ReplaySourceTest, PlaysTwoNamedFiles) {
  add("a.pgm", 5);
  add("b.pgm", 6);
  const ReplaySources sources = open_replay(directory_ / "a.pgm", directory_ / "b.pgm", {.fps = 0});
  EXPECT_EQ(sources.left->next(kLong).frame().luma.data[0], 5);
  EXPECT_EQ(sources.right->next(kLong).frame().luma.data[0], 6);
}

TEST_F(ReplaySourceTest, RefusesImpossibleRates) {
  add_pairs(1);
  for (const double fps : {-1.0, 1001.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(open_replay(directory_.path(), {.fps = fps}), std::invalid_argument);
  }
}

TEST_F(ReplaySourceTest, SortsByNumberNotByName) {
  for (const int i : {10, 9, 100, 2}) {
    add("left_" + std::to_string(i) + ".pgm", i);
    add("right_" + std::to_string(i) + ".pgm", i + 100);
  }
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{2, 102}, {9, 109}, {10, 110}, {100, 200}}));
}

TEST_F(ReplaySourceTest, KnowsManyNames) {
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
  add("disparity_00.pgm", 77);  // does not matter
  write_bytes(directory_ / "left_99.txt", bytes_of("nor does this"));
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{0, 100}, {1, 101}, {2, 102}, {3, 103}, {4, 104}}));
}

TEST_F(ReplaySourceTest, KnowsTheOnlyPairWithoutNumber) {
  add("left.pgm", 1);
  add("right.pgm", 2);
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{1, 2}}));
}

TEST_F(ReplaySourceTest, KnowsFolders) {
  add("left/0002.pgm", 2);
  add("left/0001.pgm", 1);
  add("right/frame_2.pgm", 102);
  add("right/frame_1.pgm", 101);
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{1, 101}, {2, 102}}));
}

TEST_F(ReplaySourceTest, KnowsFoldersOfOneLetter) {
  add("L/7.pgm", 7);
  add("R/7.pgm", 107);
  EXPECT_EQ(recorded(), (std::vector<std::pair<int, int>>{{7, 107}}));
}

TEST_F(ReplaySourceTest, NamesAMissingPartner) {
  add_pairs(2);
  add("left_5.pgm", 5);
  EXPECT_EQ(refusal(),
            in_directory("left_5.pgm") + ": has no partner; there is no right image with its number");
  std::filesystem::remove(directory_ / "left_5.pgm");
  std::filesystem::remove(directory_ / "left_1.pgm");
  EXPECT_EQ(refusal(),
            in_directory("right_1.pgm") + ": has no partner; there is no left image with its number");
}

TEST_F(ReplaySourceTest, NamesTwoWithOneNumber) {
  add_pairs(2);
  add("left_01.pgm", 5);
  EXPECT_EQ(refusal(),
            in_directory("left_1.pgm") + ": has the same number as left_01.pgm; each pair needs its own");
}

TEST_F(ReplaySourceTest, SaysWhatADirectoryWithoutPairsLacks) {
  add("image.pgm", 1);
  EXPECT_EQ(
      refusal(),
      directory_.path().string() +
          ": there is no stereo pair in it; files like left_00.png and right_00.png, or directories left "
          "and right with numbered images, are needed");
  EXPECT_EQ(file_error_of([&] { Recording recording(directory_ / "none"); }),
            in_directory("none") + ": the directory does not exist");
  EXPECT_EQ(file_error_of([&] { Recording recording(directory_ / "image.pgm"); }),
            in_directory("image.pgm") + ": is no directory; a directory of numbered pairs is needed");
}

TEST_F(ReplaySourceTest, NamesAPictureOfAnotherSize) {
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

TEST_F(ReplaySourceTest, NamesAPictureThatCannotBeRead) {
  add_pairs(2);
  write_bytes(directory_ / "right_1.pgm", bytes_of("P5 4 3 255\nabc"));
  EXPECT_EQ(refusal(),
            in_directory("right_1.pgm") + ": the PGM file is truncated; it ends before its image does");
}

TEST_F(ReplaySourceTest, TakesNoMoreThanAGibibyte) {
  // 33 pairs of 4096² pixels; only the first is read before that is seen.
  const Bytes large = make_png(PngKind::kGray, 1, false, {4096, 4096}, std::vector<int>(4096 * 4096));
  write_bytes(directory_ / "large.png", large);
  for (int i = 0; i < 33; ++i) {
    std::filesystem::create_hard_link(directory_ / "large.png",
                                      directory_ / ("left" + std::to_string(i) + ".png"));
    std::filesystem::create_hard_link(directory_ / "large.png",
                                      directory_ / ("right" + std::to_string(i) + ".png"));
  }
  EXPECT_EQ(refusal(),
            directory_.path().string() +
                ": 33 pairs of 4096×4096 pixels do not fit into 1 GiB, the most that is replayed; take out "
                "some");
}

}  // namespace
}  // namespace stereod
