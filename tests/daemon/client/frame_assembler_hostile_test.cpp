// SPDX-License-Identifier: BSD-3-Clause
// The frame assembler with messages that are not from stereod.
#include "daemon/client/stereod_client.h"
#include "daemon/lcm/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/support/frame_messages.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

TEST(FrameAssembler, SingleForeignNumbers_Ignored) {
  for (const std::int64_t foreign :
       {std::numeric_limits<std::int64_t>::max(), std::int64_t{5000}, std::int64_t{0}}) {
    AssemblerFixture f;
    for (int i = 1000; i < 1010; ++i) {
      f.take_frame(i);
      f.assembler.take(rows_of(foreign, 0));
    }
    f.assembler.finish();
    EXPECT_EQ(f.counts().frames_complete, 10) << foreign;
    EXPECT_EQ(f.counts().restarts, 0) << foreign;
    EXPECT_EQ(f.counts().messages_ignored, 10) << foreign;
    EXPECT_EQ(f.frames.size(), 10U) << foreign;
  }
}

// A message whose exposure does not agree with its number belongs to another numbering, however near the number is.
TEST(FrameAssembler, SingleForeignExposure_Ignored) {
  for (const std::int64_t step : {std::int64_t{10}, std::int64_t{1000}}) {
    AssemblerFixture f;
    for (int i = 1000; i < 1010; ++i) {
      f.take_frame(i);
      disparity_rows_t foreign = rows_of(i + step, 0);
      foreign.utime = std::int64_t{8'000'000'000'000'000'000};
      f.assembler.take(foreign);
    }
    f.assembler.finish();
    EXPECT_EQ(f.counts().frames_complete, 10) << step;
    EXPECT_EQ(f.counts().frames_missing, 0) << step;
    EXPECT_EQ(f.counts().restarts, 0) << step;
  }
}

// Two daemons with equal settings that were started together.
TEST(FrameAssembler, SecondDaemon_Counted) {
  AssemblerFixture f;
  for (int i = 0; i < 10; ++i) {
    f.assembler.take(rows_of(i, 0));
    disparity_rows_t other = rows_of(i, 2);
    other.utime += 1234;
    f.assembler.take(other);
    f.take_frame(i);
  }
  f.assembler.finish();
  EXPECT_EQ(f.counts().frames_complete, 10);
  EXPECT_EQ(f.counts().messages_of_another, 10);
  EXPECT_NE(describe_problems(f.counts()).find("another stereod publishes on the same channels"),
            std::string::npos)
      << describe_problems(f.counts());
}

TEST(FrameAssembler, FirstMessageForeign_Recovers) {
  AssemblerFixture f;
  f.assembler.take(rows_of(std::numeric_limits<std::int64_t>::max(), 0));
  for (int i = 0; i < 5; ++i) f.take_frame(i);
  f.assembler.finish();
  EXPECT_EQ(f.counts().frames_complete, 4);
  EXPECT_EQ(f.counts().rows_lost, 0);
}

TEST(FrameAssembler, ContradictingRows_Ignored) {
  AssemblerFixture f;
  f.assembler.take(rows_of(0, 0));
  const auto ignored = [&f](auto change) {
    disparity_rows_t m = rows_of(0, 2);
    change(m);
    const std::int64_t before = f.counts().messages_ignored;
    f.assembler.take(m);
    return f.counts().messages_ignored == before + 1;
  };
  EXPECT_TRUE(ignored([](auto& m) { m.utime -= 1; }));
  EXPECT_TRUE(ignored([](auto& m) { m.scale = 1; }));
  EXPECT_TRUE(ignored([](auto& m) { m.disparities = 32; }));
  EXPECT_TRUE(ignored([](auto& m) { m.min_disparity = 1; }));
  EXPECT_TRUE(ignored([](auto& m) { m.height += 2; }));
  EXPECT_TRUE(ignored([](auto& m) { m.left = 1; }));
  EXPECT_TRUE(ignored([](auto& m) { m.top = 1; }));
  EXPECT_TRUE(ignored([](auto& m) { m.decimation_x = 2; }));
  EXPECT_TRUE(ignored([](auto& m) { m.decimation_y = 2; }));
  EXPECT_TRUE(ignored([](auto& m) {
    m.width /= 2;
    m.row_count *= 2;
  }));
  frame_t summary = summary_of(0);
  summary.height -= 1;
  summary.rows = 1;
  f.assembler.take(summary);
  EXPECT_EQ(f.counts().messages_ignored, 11);
  f.take_frame(0);
  ASSERT_EQ(f.frames.size(), 1U);
  expect_pixels(f.frames[0]);
}

constexpr std::array<std::int32_t, 16> kHostile = {0,
                                                   1,
                                                   -1,
                                                   2,
                                                   10,
                                                   12,
                                                   13,
                                                   255,
                                                   4096,
                                                   4097,
                                                   65535,
                                                   65536,
                                                   1 << 30,
                                                   std::numeric_limits<std::int32_t>::max(),
                                                   std::numeric_limits<std::int32_t>::min(),
                                                   std::numeric_limits<std::int32_t>::min() + 1};

TEST(FrameAssembler, InvalidRows_Ignored) {
  AssemblerFixture f;
  int tried = 0;
  const auto take = [&](const disparity_rows_t& m) {
    f.assembler.take(m);
    ++tried;
  };
  const auto with = [&take](auto change) {
    disparity_rows_t m = rows_of(0, 0);
    change(m);
    take(m);
  };
  for (const std::int32_t value : kHostile) {
    if (value != kWidth) with([value](auto& m) { m.width = value; });
    if (value < 2 || value > kMaxImageSide) with([value](auto& m) { m.height = value; });
    if (value != kRowsPerMessage) with([value](auto& m) { m.row_count = value; });
    if (value < 0 || value > kHeight - kRowsPerMessage) with([value](auto& m) { m.first_row = value; });
    if (value != rows_of(0, 0).size) with([value](auto& m) { m.size = value; });
    if (value != 2)
      with([value](auto& m) { m.bytes_per_value = static_cast<std::int8_t>(value == 258 ? 3 : value); });
    if (value < 1 || value > 4096) with([value](auto& m) { m.disparities = value; });
    if (value < 0 || value > 4096) with([value](auto& m) { m.min_disparity = value; });
    if (value < 0 || value > 65535) with([value](auto& m) { m.invalid = value; });
    // The last column or row would lie outside any image.
    if (value < 0 || value >= 4095) with([value](auto& m) { m.left = m.top = value; });
    if (value < 1 || value >= 4095) with([value](auto& m) { m.decimation_x = value; });
    if (value < 1 || value >= 4095) with([value](auto& m) { m.decimation_y = value; });
    // The right size is 4: two rows of 12 bits, each in whole bytes.
    if (value != 0 && value != 4) with([value](auto& m) { m.filled_size = value; });
    if (value > 0 && value < 256 && value != 4)
      with([value](auto& m) {
        m.filled_size = value;
        m.filled.resize(static_cast<std::size_t>(value));
      });
  }
  for (const float scale : {0.0F, -1.0F, 2.0F, 0.5F, NAN, INFINITY})
    with([scale](auto& m) { m.scale = scale; });
  with([](auto& m) { m.frame = -1; });
  with([](auto& m) { m.utime = -1; });
  with([](auto& m) { m.data.pop_back(); });
  with([](auto& m) { m.data.clear(); });
  with([](auto& m) { m.filled_size = 4; });
  EXPECT_EQ(f.counts().messages_ignored, tried);
  f.assembler.finish();
  EXPECT_TRUE(f.frames.empty());
}

TEST(FrameAssembler, InvalidSummaries_Ignored) {
  AssemblerFixture f;
  int tried = 0;
  const auto with = [&](auto change) {
    frame_t m = summary_of(0);
    change(m);
    f.assembler.take(m);
    ++tried;
  };
  with([](auto& m) { m.frame = -5; });
  with([](auto& m) { m.rows = -1; });
  with([](auto& m) { m.rows = kHeight + 1; });
  with([](auto& m) { m.width = 0; });
  with([](auto& m) { m.height = 1 << 30; });
  with([](auto& m) { m.messages = -1; });
  with([](auto& m) { m.measured_fraction = NAN; });
  with([](auto& m) { m.measured_fraction = 1.5F; });
  EXPECT_EQ(f.counts().messages_ignored, tried);
}

TEST(FrameAssembler, HostileFields_Survives) {
  Random random(3);
  AssemblerFixture f;
  const auto hostile = [&random](std::int32_t valid) {
    return random.one_in(4) ? random.one_of(kHostile) : valid;
  };
  for (int round = 0; round < 20'000; ++round) {
    const std::int64_t frame = random.one_in(50)   ? static_cast<std::int64_t>(random.next())
                               : random.one_in(20) ? random.between(0, 3000)
                                                   : round / 10;
    if (random.one_in(5)) {
      frame_t m = summary_of(frame & std::numeric_limits<std::int32_t>::max());
      m.frame = frame;
      m.width = hostile(m.width);
      m.height = hostile(m.height);
      m.rows = hostile(m.rows);
      f.assembler.take(m);
      continue;
    }
    disparity_rows_t m = rows_of(round / 10, random.between(0, kHeight / 2 - 1) * 2);
    m.frame = frame;
    if (random.one_in(2)) mark_filled(m, [](int x, int) { return x % 2 == 0; });
    m.width = hostile(m.width);
    m.height = hostile(m.height);
    m.first_row = hostile(m.first_row);
    m.row_count = hostile(m.row_count);
    if (random.one_in(8)) m.bytes_per_value = static_cast<std::int8_t>(random.between(-128, 127));
    m.invalid = hostile(m.invalid);
    m.left = hostile(m.left);
    m.decimation_x = hostile(m.decimation_x);
    m.size = hostile(m.size);
    m.filled_size = hostile(m.filled_size);
    if (random.one_in(2)) m.data.resize(static_cast<std::size_t>(std::clamp(m.size, 0, 100'000)));
    f.assembler.take(m);
    if (f.frames.size() > 100) f.frames.clear();
  }
  f.assembler.finish();
  expect_sums(f.counts());
  EXPECT_GT(f.counts().messages_ignored, 1000);
}

}  // namespace
}  // namespace stereod
