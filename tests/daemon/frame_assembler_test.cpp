#include "daemon/tools/tap/frame_assembler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "tests/support/random_images.h"

namespace stereod {
namespace {

constexpr int kWidth = 12;
constexpr int kHeight = 10;
constexpr int kRowsPerMessage = 2;

std::int64_t utime_of(std::int64_t frame) { return 1'700'000'000'000'000 + frame % 1'000'000 * 33'333; }

/// The wire value of a pixel in these tests: another for each frame, row and column, sometimes invalid.
int value_at(std::int64_t frame, int x, int y) {
  const int value = static_cast<int>((frame % 1000 * 31 + y * 17 + x * 5) % 1000);
  return value % 7 == 0 ? 65535 : value;
}

disparity_rows_t rows_of(std::int64_t frame, int first_row, int count = kRowsPerMessage) {
  disparity_rows_t m{};
  m.utime = utime_of(frame);
  m.frame = frame;
  m.width = kWidth;
  m.height = kHeight;
  m.first_row = first_row;
  m.row_count = count;
  m.disparities = 64;
  m.scale = 0.0625F;
  m.bytes_per_value = 2;
  m.invalid = 65535;
  for (int y = first_row; y < first_row + count; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int value = value_at(frame, x, y);
      m.data.push_back(static_cast<std::uint8_t>(value & 0xFF));
      m.data.push_back(static_cast<std::uint8_t>(value >> 8));
    }
  }
  m.size = static_cast<std::int32_t>(m.data.size());
  return m;
}

frame_t summary_of(std::int64_t frame) {
  frame_t m{};
  m.utime = utime_of(frame);
  m.frame = frame;
  m.width = kWidth;
  m.height = kHeight;
  m.rows = kHeight;
  m.messages = kHeight / kRowsPerMessage;
  m.valid_fraction = 0.5F;
  return m;
}

using Message = std::variant<disparity_rows_t, frame_t>;

std::vector<Message> messages_of(std::int64_t frame) {
  std::vector<Message> messages;
  for (int y = 0; y < kHeight; y += kRowsPerMessage) messages.emplace_back(rows_of(frame, y));
  messages.emplace_back(summary_of(frame));
  return messages;
}

/// An assembler and what it handed over.
struct Fixture {
  std::vector<AssembledFrame> frames;
  FrameAssembler assembler{[this](AssembledFrame&& frame) { frames.push_back(std::move(frame)); }};

  void take(const Message& message) {
    std::visit([this](const auto& m) { assembler.take(m); }, message);
  }
  void take_all(const std::vector<Message>& messages) {
    for (const Message& message : messages) take(message);
  }
  void take_frame(std::int64_t frame) { take_all(messages_of(frame)); }
  const ReceptionCounts& counts() const { return assembler.counts(); }
};

void expect_pixels(const AssembledFrame& frame) {
  ASSERT_EQ(frame.disparity.size(), (Size{kWidth, kHeight}));
  ASSERT_EQ(frame.row_present.size(), static_cast<std::size_t>(kHeight));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int sent = value_at(frame.frame, x, y);
      const bool valid = sent != 65535 && frame.row_present[static_cast<std::size_t>(y)];
      EXPECT_EQ(frame.disparity.at(x, y), valid ? sent : kInvalidDisparity)
          << "frame " << frame.frame << " " << y;
    }
  }
}

void expect_sums(const ReceptionCounts& c) {
  EXPECT_EQ(c.frames_expected, c.frames_complete + c.frames_incomplete + c.frames_missing);
  EXPECT_EQ(c.rows_expected, c.rows_received + c.rows_lost);
  EXPECT_GE(std::min({c.frames_expected, c.frames_complete, c.frames_incomplete, c.frames_missing}), 0);
  EXPECT_GE(std::min({c.rows_expected, c.rows_received, c.rows_lost, c.rows_duplicate}), 0);
}

TEST(FrameAssembler, HandsAFrameOverAsSoonAsItIsWhole) {
  Fixture f;
  const auto messages = messages_of(0);
  for (std::size_t i = 0; i + 1 < messages.size(); ++i) f.take(messages[i]);
  EXPECT_TRUE(f.frames.empty());
  f.take(messages.back());
  ASSERT_EQ(f.frames.size(), 1U);
  EXPECT_TRUE(f.frames[0].complete());
  EXPECT_EQ(f.frames[0].units_per_pixel, 16);
  EXPECT_EQ(f.frames[0].disparities, 64);
  EXPECT_EQ(f.frames[0].utime, utime_of(0));
  expect_pixels(f.frames[0]);
}

TEST(FrameAssembler, TakesRowsInAnyOrder) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    Fixture f;
    std::vector<Message> messages = messages_of(3);
    for (std::size_t i = messages.size(); i > 1; --i) {
      std::swap(messages[i - 1],
                messages[static_cast<std::size_t>(random.between(0, static_cast<int>(i) - 1))]);
    }
    f.take_all(messages);
    ASSERT_EQ(f.frames.size(), 1U);
    EXPECT_TRUE(f.frames[0].complete());
    expect_pixels(f.frames[0]);
  }
}

TEST(FrameAssembler, KeepsInterleavedFramesApart) {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    Fixture f;
    std::vector<Message> messages = messages_of(5);
    for (const Message& message : messages_of(6)) messages.push_back(message);
    for (std::size_t i = messages.size(); i > 1; --i) {
      std::swap(messages[i - 1],
                messages[static_cast<std::size_t>(random.between(0, static_cast<int>(i) - 1))]);
    }
    f.take_all(messages);
    f.assembler.finish();
    ASSERT_EQ(f.frames.size(), 2U);
    for (const AssembledFrame& frame : f.frames) {
      EXPECT_TRUE(frame.complete());
      expect_pixels(frame);
    }
    EXPECT_EQ(f.counts().frames_complete, 2);
    EXPECT_EQ(f.counts().frames_expected, 2);
    EXPECT_EQ(f.counts().messages_ignored, 0);
  }
}

TEST(FrameAssembler, ReadsOneByteValuesAndOddInvalids) {
  Fixture f;
  disparity_rows_t m = rows_of(0, 0, kHeight);
  m.bytes_per_value = 1;
  m.scale = 1;
  m.invalid = 255;
  m.data.assign(kWidth * kHeight, 9);
  m.data[0] = 255;
  m.data[1] = 254;
  m.size = kWidth * kHeight;
  f.assembler.take(m);
  f.assembler.take(summary_of(0));
  ASSERT_EQ(f.frames.size(), 1U);
  EXPECT_EQ(f.frames[0].units_per_pixel, 1);
  EXPECT_EQ(f.frames[0].disparity.at(0, 0), kInvalidDisparity);
  EXPECT_EQ(f.frames[0].disparity.at(1, 0), 254);
  EXPECT_EQ(f.frames[0].disparity.at(2, 0), 9);
}

TEST(FrameAssembler, TakesValuesBeyondInt16AsNoDisparity) {
  Fixture f;
  disparity_rows_t m = rows_of(0, 0, kHeight);
  m.data[0] = 0xFF;
  m.data[1] = 0x7F;
  m.data[2] = 0x00;
  m.data[3] = 0x80;
  f.assembler.take(m);
  f.assembler.take(summary_of(0));
  ASSERT_EQ(f.frames.size(), 1U);
  EXPECT_EQ(f.frames[0].disparity.at(0, 0), 32767);
  EXPECT_EQ(f.frames[0].disparity.at(1, 0), kInvalidDisparity);
}

TEST(FrameAssembler, HandsOverWhatItHasWhenTwoNewerFramesHaveBegun) {
  Fixture f;
  f.take_frame(0);
  for (const int row : {0, 2, 6, 8}) f.assembler.take(rows_of(1, row));
  f.assembler.take(summary_of(1));
  f.take_frame(2);
  EXPECT_EQ(f.frames.size(), 2U);  // 0 and 2: 1 may still be made whole
  f.assembler.take(rows_of(3, 0));
  ASSERT_EQ(f.frames.size(), 3U);
  const AssembledFrame& frame = f.frames[2];
  EXPECT_EQ(frame.frame, 1);
  EXPECT_FALSE(frame.complete());
  EXPECT_EQ(frame.rows_received, 8);
  EXPECT_FALSE(frame.row_present[4]);
  EXPECT_TRUE(frame.row_present[6]);
  expect_pixels(frame);
  EXPECT_EQ(f.counts().frames_incomplete, 1);
  EXPECT_EQ(f.counts().rows_lost, 2);
  f.assembler.take(rows_of(1, 4));  // too late
  EXPECT_EQ(f.counts().messages_late, 1);
  EXPECT_EQ(f.frames.size(), 3U);
}

TEST(FrameAssembler, ReportsAFrameWhoseLastMessageIsMissing) {
  Fixture f;
  f.take_frame(0);
  for (int row = 0; row < kHeight; row += 2) f.assembler.take(rows_of(1, row));
  f.take_frame(2);
  f.take_frame(3);
  f.assembler.finish();
  EXPECT_EQ(f.counts().frames_incomplete, 1);
  EXPECT_EQ(f.counts().rows_lost, 0);
  const auto frame =
      std::find_if(f.frames.begin(), f.frames.end(), [](const auto& x) { return x.frame == 1; });
  ASSERT_NE(frame, f.frames.end());
  EXPECT_FALSE(frame->complete());
  EXPECT_FALSE(frame->summary);
  EXPECT_EQ(frame->rows_received, kHeight);
}

TEST(FrameAssembler, CountsDuplicatesOnce) {
  Fixture f;
  f.assembler.take(rows_of(0, 0));
  f.assembler.take(rows_of(0, 0));
  EXPECT_EQ(f.counts().rows_duplicate, 2);
  f.take_frame(0);
  EXPECT_EQ(f.counts().rows_duplicate, 4);
  ASSERT_EQ(f.frames.size(), 1U);
  expect_pixels(f.frames[0]);
  f.take_frame(0);  // once more after it was handed over
  EXPECT_EQ(f.frames.size(), 1U);
  EXPECT_EQ(f.counts().rows_duplicate, 4 + kHeight);
}

TEST(FrameAssembler, CountsFramesOfWhichNothingCame) {
  Fixture f;
  f.take_frame(10);
  f.take_frame(14);
  f.assembler.finish();
  EXPECT_EQ(f.counts().frames_expected, 5);
  EXPECT_EQ(f.counts().frames_complete, 2);
  EXPECT_EQ(f.counts().frames_missing, 3);
  EXPECT_EQ(f.counts().rows_lost, 3 * kHeight);
}

TEST(FrameAssembler, LeavesOutTheFramesUnderWayAtBeginningAndEnd) {
  Fixture f;
  f.assembler.take(rows_of(7, 6));
  f.assembler.take(rows_of(7, 8));
  f.assembler.take(summary_of(7));
  f.take_frame(8);
  f.take_frame(9);
  f.assembler.take(rows_of(10, 0));
  f.assembler.finish();
  EXPECT_EQ(f.counts().frames_expected, 2);
  EXPECT_EQ(f.counts().frames_complete, 2);
  EXPECT_EQ(f.counts().rows_lost, 0);
  EXPECT_EQ(f.frames.size(), 4U);  // but they are handed over
}

TEST(FrameAssembler, ExpectsNoMoreRowsThanWerePublished) {
  Fixture f;
  f.take_frame(0);
  for (const int row : {2, 4, 6}) f.assembler.take(rows_of(1, row));
  frame_t summary = summary_of(1);
  summary.rows = 6;
  f.assembler.take(summary);
  ASSERT_EQ(f.frames.size(), 2U);
  EXPECT_TRUE(f.frames[1].complete());
  EXPECT_EQ(f.frames[1].rows_expected, 6);
  expect_pixels(f.frames[1]);
}

TEST(FrameAssembler, FollowsADaemonThatWasStartedAgain) {
  Fixture f;
  for (int i = 0; i < 100; ++i) f.take_frame(i);
  for (int i = 0; i < 10; ++i) {
    for (Message message : messages_of(i)) {
      std::visit([](auto& m) { m.utime += 60'000'000; }, message);
      f.take(message);
    }
  }
  f.assembler.finish();
  EXPECT_EQ(f.counts().restarts, 1);
  EXPECT_EQ(f.counts().frames_complete, 100 + 9);  // the first one told it of the restart
  EXPECT_EQ(f.counts().frames_missing, 0);
  EXPECT_EQ(f.counts().rows_lost, 0);
}

TEST(FrameAssembler, IsNotLedAstrayBySingleForeignNumbers) {
  for (const std::int64_t foreign :
       {std::numeric_limits<std::int64_t>::max(), std::int64_t{5000}, std::int64_t{0}}) {
    Fixture f;
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

TEST(FrameAssembler, RecoversIfTheVeryFirstMessageIsForeign) {
  Fixture f;
  f.assembler.take(rows_of(std::numeric_limits<std::int64_t>::max(), 0));
  for (int i = 0; i < 5; ++i) f.take_frame(i);
  f.assembler.finish();
  EXPECT_EQ(f.counts().frames_complete, 4);
  EXPECT_EQ(f.counts().rows_lost, 0);
}

TEST(FrameAssembler, IgnoresWhatContradictsTheFrame) {
  Fixture f;
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
  EXPECT_TRUE(ignored([](auto& m) {
    m.width /= 2;
    m.row_count *= 2;
  }));
  frame_t summary = summary_of(0);
  summary.height -= 1;
  summary.rows = 1;
  f.assembler.take(summary);
  EXPECT_EQ(f.counts().messages_ignored, 7);
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

TEST(FrameAssembler, IgnoresSizesThatDoNotFit) {
  Fixture f;
  int tried = 0;
  const auto take = [&](disparity_rows_t m) {
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
    if (value < 2 || value > FrameAssembler::kMaxSide) with([value](auto& m) { m.height = value; });
    if (value != kRowsPerMessage) with([value](auto& m) { m.row_count = value; });
    if (value < 0 || value > kHeight - kRowsPerMessage) with([value](auto& m) { m.first_row = value; });
    if (value != rows_of(0, 0).size) with([value](auto& m) { m.size = value; });
    if (value != 2)
      with([value](auto& m) { m.bytes_per_value = static_cast<std::int8_t>(value == 258 ? 3 : value); });
    if (value < 1 || value > 4096) with([value](auto& m) { m.disparities = value; });
    if (value < 0 || value > 4096) with([value](auto& m) { m.min_disparity = value; });
    if (value < 0 || value > 65535) with([value](auto& m) { m.invalid = value; });
  }
  for (const float scale : {0.0F, -1.0F, 2.0F, 0.5F, NAN, INFINITY})
    with([scale](auto& m) { m.scale = scale; });
  with([](auto& m) { m.frame = -1; });
  with([](auto& m) { m.utime = -1; });
  with([](auto& m) { m.data.pop_back(); });
  with([](auto& m) { m.data.clear(); });
  EXPECT_EQ(f.counts().messages_ignored, tried);
  f.assembler.finish();
  EXPECT_TRUE(f.frames.empty());
}

TEST(FrameAssembler, IgnoresSummariesThatMakeNoSense) {
  Fixture f;
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
  with([](auto& m) { m.valid_fraction = NAN; });
  with([](auto& m) { m.valid_fraction = 1.5F; });
  EXPECT_EQ(f.counts().messages_ignored, tried);
}

TEST(FrameAssembler, SurvivesHostileFields) {
  Random random(3);
  Fixture f;
  const auto hostile = [&random](std::int32_t sane) {
    return random.one_in(4) ? random.one_of(kHostile) : sane;
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
    m.width = hostile(m.width);
    m.height = hostile(m.height);
    m.first_row = hostile(m.first_row);
    m.row_count = hostile(m.row_count);
    if (random.one_in(8)) m.bytes_per_value = static_cast<std::int8_t>(random.between(-128, 127));
    m.invalid = hostile(m.invalid);
    m.size = hostile(m.size);
    if (random.one_in(2)) m.data.resize(static_cast<std::size_t>(std::clamp(m.size, 0, 100'000)));
    f.assembler.take(m);
    if (f.frames.size() > 100) f.frames.clear();
  }
  f.assembler.finish();
  expect_sums(f.counts());
  EXPECT_GT(f.counts().messages_ignored, 1000);
}

/// Messages overtake each other by up to three places, as datagrams do, never by a frame.
void overtake(std::vector<Message>& messages, Random& random) {
  std::vector<std::pair<int, Message>> places;
  for (const Message& message : messages) {
    places.emplace_back(static_cast<int>(places.size()) + random.between(0, 3), message);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::transform(places.begin(), places.end(), messages.begin(),
                 [](const auto& place) { return place.second; });
}

TEST(FrameAssembler, CountsAddUpWhateverIsLostAndShuffled) {
  Random random(4);
  for (int round = 0; round < 50; ++round) {
    Fixture f;
    constexpr int kFrames = 60;
    std::int64_t lost_rows = 0;
    std::vector<Message> messages;
    for (int i = 0; i < kFrames; ++i) {
      for (const Message& message : messages_of(i)) {
        const bool may_lose = i > 0 && i < kFrames - 1;
        if (may_lose && random.one_in(20)) {
          if (std::holds_alternative<disparity_rows_t>(message)) lost_rows += kRowsPerMessage;
          continue;
        }
        messages.push_back(message);
        if (random.one_in(20)) messages.push_back(message);
      }
    }
    overtake(messages, random);
    f.take_all(messages);
    f.assembler.finish();
    expect_sums(f.counts());
    EXPECT_EQ(f.counts().frames_expected, kFrames);
    EXPECT_EQ(f.counts().rows_lost, lost_rows);
    EXPECT_EQ(f.counts().messages_ignored, 0);
    EXPECT_EQ(f.frames.size(), static_cast<std::size_t>(kFrames - f.counts().frames_missing));
    for (const AssembledFrame& frame : f.frames) expect_pixels(frame);
  }
}

}  // namespace
}  // namespace stereod
