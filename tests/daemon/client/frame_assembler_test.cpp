// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client/stereod_client.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "tests/support/frame_messages.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

TEST(FrameAssembler, CompleteFrame_HandedOverAtOnce) {
  AssemblerFixture f;
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

TEST(FrameAssembler, RowsInAnyOrder_Assembled) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    AssemblerFixture f;
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

TEST(FrameAssembler, InterleavedFrames_KeptApart) {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    AssemblerFixture f;
    std::vector<Message> messages = messages_of(5);
    for (const Message& message : messages_of(6)) messages.push_back(message);
    const Message last = messages.back();
    messages.pop_back();
    for (std::size_t i = messages.size(); i > 1; --i) {
      std::swap(messages[i - 1],
                messages[static_cast<std::size_t>(random.between(0, static_cast<int>(i) - 1))]);
    }
    f.take_all(messages);
    f.take(last);
    f.assembler.finish();
    ASSERT_EQ(f.frames.size(), 2U);
    for (const StereoFrame& frame : f.frames) {
      EXPECT_TRUE(frame.complete());
      expect_pixels(frame);
    }
    EXPECT_EQ(f.counts().frames_complete, 2);
    EXPECT_EQ(f.counts().frames_expected, 2);
    EXPECT_EQ(f.counts().messages_ignored, 0);
  }
}

TEST(FrameAssembler, OneByteValues_Decoded) {
  AssemblerFixture f;
  disparity_rows_t m = rows_of(0, 0, kHeight);
  m.bytes_per_value = 1;
  m.scale = 1;
  m.invalid = 255;
  m.data.assign(std::size_t{kWidth} * kHeight, 9);
  m.data[0] = 255;
  m.data[1] = 254;
  m.size = kWidth * kHeight;
  f.assembler.take(m);
  f.assembler.take(summary_of(0));
  ASSERT_EQ(f.frames.size(), 1U);
  EXPECT_EQ(f.frames[0].units_per_pixel, 1);
  EXPECT_EQ(f.frames[0].disparity.at(0, 0), DisparityMap::kNone);
  EXPECT_EQ(f.frames[0].disparity.at(1, 0), 254);
  EXPECT_EQ(f.frames[0].disparity.at(2, 0), 9);
}

TEST(FrameAssembler, ValuesBeyondInt16_NoDisparity) {
  AssemblerFixture f;
  disparity_rows_t m = rows_of(0, 0, kHeight);
  m.data[0] = 0xFF;
  m.data[1] = 0x7F;
  m.data[2] = 0x00;
  m.data[3] = 0x80;
  f.assembler.take(m);
  f.assembler.take(summary_of(0));
  ASSERT_EQ(f.frames.size(), 1U);
  EXPECT_EQ(f.frames[0].disparity.at(0, 0), 32767);
  EXPECT_EQ(f.frames[0].disparity.at(1, 0), DisparityMap::kNone);
}

TEST(FrameAssembler, Confidence_Assembled) {
  const auto with_confidence = [](int first_row) {
    disparity_rows_t rows = rows_of(1, first_row);
    for (int i = 0; i < kWidth * rows.row_count; ++i) {
      rows.confidence.push_back(static_cast<std::uint8_t>(first_row * kWidth + i));
    }
    rows.confidence_size = static_cast<std::int32_t>(rows.confidence.size());
    return rows;
  };
  AssemblerFixture f;
  for (int y = 0; y < kHeight; y += kRowsPerMessage) {
    if (y != 4) f.assembler.take(with_confidence(y));
  }
  f.assembler.take(summary_of(1));
  f.take_frame(2);
  ASSERT_EQ(f.frames.size(), 2U);
  const ConfidenceMap& confidence = f.frames[0].confidence;
  ASSERT_EQ(confidence.width(), kWidth);
  ASSERT_EQ(confidence.height(), kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      EXPECT_EQ(confidence.at(x, y), y == 4 || y == 5 ? 0 : y * kWidth + x) << x << ", " << y;
    }
  }
  EXPECT_EQ(f.frames[1].confidence.width(), 0) << "not published";
  disparity_rows_t bad = with_confidence(0);
  bad.confidence.pop_back();
  bad.confidence_size--;
  f.assembler.take(bad);
  EXPECT_EQ(f.counts().messages_ignored, 1);
}

TEST(FrameAssembler, NextFrameComplete_HandsOverIncomplete) {
  AssemblerFixture f;
  f.take_frame(0);
  for (const int row : {0, 2, 6, 8}) f.assembler.take(rows_of(1, row));
  f.assembler.take(summary_of(1));
  EXPECT_EQ(f.frames.size(), 1U);
  f.take_frame(2);
  ASSERT_EQ(f.frames.size(), 3U);
  const StereoFrame& frame = f.frames[1];
  EXPECT_EQ(frame.frame, 1);
  EXPECT_FALSE(frame.complete());
  EXPECT_EQ(frame.rows_received, 8);
  EXPECT_FALSE(frame.row_present[4]);
  EXPECT_TRUE(frame.row_present[6]);
  expect_pixels(frame);
  EXPECT_EQ(f.frames[2].frame, 2);
  EXPECT_TRUE(f.frames[2].complete());
  f.assembler.take(rows_of(1, 4));  // late
  f.assembler.take(rows_of(1, 2));  // duplicate
  EXPECT_EQ(f.counts().messages_late, 1);
  EXPECT_EQ(f.counts().rows_duplicate, 2);
  EXPECT_EQ(f.frames.size(), 3U);
  f.assembler.finish();
  EXPECT_EQ(f.counts().frames_incomplete, 1);
  EXPECT_EQ(f.counts().rows_lost, 2);
}

TEST(FrameAssembler, TwoNewerFrames_HandsOverIncomplete) {
  AssemblerFixture f;
  f.take_frame(0);
  f.assembler.take(rows_of(1, 0));
  f.assembler.take(rows_of(2, 0));
  EXPECT_EQ(f.frames.size(), 1U);  // frame 1 may still become complete
  f.assembler.take(rows_of(3, 0));
  ASSERT_EQ(f.frames.size(), 2U);
  EXPECT_EQ(f.frames[1].frame, 1);
  EXPECT_EQ(f.frames[1].rows_received, 2);
  f.assembler.take(rows_of(1, 4));  // late
  EXPECT_EQ(f.counts().messages_late, 1);
  EXPECT_EQ(f.frames.size(), 2U);
}

TEST(FrameAssembler, SummaryMissing_Incomplete) {
  AssemblerFixture f;
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

TEST(FrameAssembler, Duplicates_CountedOnce) {
  AssemblerFixture f;
  f.assembler.take(rows_of(0, 0));
  f.assembler.take(rows_of(0, 0));
  EXPECT_EQ(f.counts().rows_duplicate, 2);
  f.take_frame(0);
  EXPECT_EQ(f.counts().rows_duplicate, 4);
  ASSERT_EQ(f.frames.size(), 1U);
  expect_pixels(f.frames[0]);
  f.take_frame(0);  // again after the handover
  EXPECT_EQ(f.frames.size(), 1U);
  EXPECT_EQ(f.counts().rows_duplicate, 4 + kHeight);
}

TEST(FrameAssembler, FramesMissing_Counted) {
  AssemblerFixture f;
  f.take_frame(10);
  f.take_frame(14);
  f.assembler.finish();
  EXPECT_EQ(f.counts().frames_expected, 5);
  EXPECT_EQ(f.counts().frames_complete, 2);
  EXPECT_EQ(f.counts().frames_missing, 3);
  EXPECT_EQ(f.counts().rows_lost, 3 * kHeight);
}

TEST(FrameAssembler, FirstAndLastIncomplete_NotCounted) {
  AssemblerFixture f;
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
  EXPECT_EQ(f.frames.size(), 4U);  // they are handed over all the same
}

TEST(FrameAssembler, FewerRowsPublished_Complete) {
  AssemblerFixture f;
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

TEST(FrameAssembler, DaemonRestarted_Followed) {
  AssemblerFixture f;
  for (int i = 0; i < 100; ++i) f.take_frame(i);
  for (int i = 0; i < 10; ++i) {
    for (Message message : messages_of(i)) {
      std::visit([](auto& m) { m.utime += 60'000'000; }, message);
      f.take(message);
    }
  }
  f.assembler.finish();
  EXPECT_EQ(f.counts().restarts, 1);
  EXPECT_EQ(f.counts().frames_complete, 100 + 9);  // the first frame revealed the restart
  EXPECT_EQ(f.counts().frames_missing, 0);
  EXPECT_EQ(f.counts().rows_lost, 0);
}

/// Shuffles messages by up to three places, as datagrams are, never by a frame.
void overtake(std::vector<Message>& messages, Random& random) {
  std::vector<std::pair<int, Message>> places;
  places.reserve(messages.size());
  for (const Message& message : messages) {
    places.emplace_back(static_cast<int>(places.size()) + random.between(0, 3), message);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::transform(places.begin(), places.end(), messages.begin(),
                 [](const auto& place) { return place.second; });
}

TEST(FrameAssembler, LostAndShuffled_CountsAddUp) {
  Random random(4);
  for (int round = 0; round < 50; ++round) {
    AssemblerFixture f;
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
    for (const StereoFrame& frame : f.frames) expect_pixels(frame);
  }
}

}  // namespace
}  // namespace stereod
