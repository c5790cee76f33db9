// SPDX-License-Identifier: BSD-3-Clause
// Recordings as cameras.
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

#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLong = std::chrono::hours(1);  // the test fails before this time has passed
constexpr milliseconds kNone{0};

Bytes pgm_image(int value, Size size = {4, 3}) {
  const std::string header =
      "P5 " + std::to_string(size.width) + " " + std::to_string(size.height) + " 255\n";
  return make_raw_pnm(header, std::vector<int>(static_cast<std::size_t>(size.width * size.height), value),
                      false);
}

class ReplaySource : public testing::Test {
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

  TemporaryDirectory directory_;
};

TEST_F(ReplaySource, NoLoop_PlaysOnceAndFinishes) {
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

TEST_F(ReplaySource, Loop_KeepsCounting) {
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

TEST_F(ReplaySource, Frame_WholeImage) {
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

TEST_F(ReplaySource, RateZero_WaitsForLease) {
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

TEST_F(ReplaySource, Paced_ConstantPeriod) {
  add_pairs(3);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 500, .loop = true});
  // A slow test misses frames, so the content of each frame is checked, not which numbers come.
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

TEST_F(ReplaySource, PacedNoLoop_Finishes) {
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

TEST_F(ReplaySource, OneSideFinished_OtherFinishes) {
  add_pairs(1);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 0, .loop = false});
  sources.left->next(kLong).end();
  sources.right->next(kLong).end();
  EXPECT_FALSE(sources.left->next(kLong));
  EXPECT_FALSE(sources.right->next(kLong));
  EXPECT_EQ(sources.right->state(), SourceState::kFinished);
}

TEST_F(ReplaySource, Stop_EndsWait) {
  add_pairs(1);
  const ReplaySources sources = open_replay(directory_.path(), {.fps = 0});
  const FrameLease on_loan = sources.left->next(kLong);
  std::thread waiting([&] { EXPECT_FALSE(sources.left->next(kLong)); });
  sources.left->stop();
  waiting.join();
  EXPECT_FALSE(sources.left->next(kLong));
}

TEST_F(ReplaySource, OneDestroyed_OtherWorks) {
  add_pairs(1);
  ReplaySources sources = open_replay(directory_.path(), {.fps = 0});
  sources.left->stop();
  sources.left.reset();
  const FrameLease lease = sources.right->next(kLong);
  EXPECT_EQ(lease.frame().luma.data[0], 110);
}

TEST_F(ReplaySource, TwoFiles_Played) {
  add("a.pgm", 5);
  add("b.pgm", 6);
  const ReplaySources sources = open_replay(directory_ / "a.pgm", directory_ / "b.pgm", {.fps = 0});
  EXPECT_EQ(sources.left->next(kLong).frame().luma.data[0], 5);
  EXPECT_EQ(sources.right->next(kLong).frame().luma.data[0], 6);
}

TEST_F(ReplaySource, RateOutOfRange_Throws) {
  add_pairs(1);
  for (const double fps : {-1.0, 1001.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(open_replay(directory_.path(), {.fps = fps}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace stereod
