// SPDX-License-Identifier: BSD-3-Clause
// Raw images of an LCM log as cameras.
#include "daemon/capture/replay/log_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "daemon/base/file_error.h"
#include "daemon/lcm/log.h"
#include "stereod/image_t.hpp"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

image_t image_of(std::int64_t utime, int value, int width = 64, int height = 48) {
  image_t image{};
  image.utime = utime;
  image.width = image.row_stride = width;
  image.height = height;
  image.pixelformat = 1497715271;
  image.size = width * height;
  image.data.assign(static_cast<std::size_t>(image.size), static_cast<std::uint8_t>(value));
  return image;
}

class LogSource : public testing::Test {
 protected:
  void write(const char* channel, const image_t& image, std::size_t cut = 0) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(image.getEncodedSize()));
    image.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    bytes.resize(bytes.size() - cut);
    writer_.write(image.utime + 5000, channel, bytes);
  }
  void write_pair(std::int64_t utime, int value) {
    write("R_LEFT_RAW", image_of(utime, value));
    write("R_RIGHT_RAW", image_of(utime + 700, value + 1));
  }
  LogSources open(bool original_pace = false, bool loop = false) {
    writer_.finish();
    return open_log(file_, {"R", original_pace, loop});
  }
  std::string error() {
    try {
      open();
    } catch (const FileError& problem) {
      return problem.what();
    }
    return "";
  }

  TemporaryDirectory directory_;
  const std::filesystem::path file_ = directory_ / "field.lcm";
  LcmLogWriter writer_{file_};
};

TEST_F(LogSource, Pairs_WithTimes) {
  for (int i = 0; i < 3; ++i) write_pair(1'000'000 + i * 33'000, 10 * i);
  LogSources log = open();
  EXPECT_EQ(log.pairs, 3);
  EXPECT_EQ(log.unpaired, 0);
  EXPECT_EQ(log.left->frame_size(), (Size{64, 48}));
  for (int i = 0; i < 3; ++i) {
    const FrameLease left = log.left->next(1s), right = log.right->next(1s);
    ASSERT_TRUE(left && right);
    EXPECT_EQ(left.frame().luma.data[0], 10 * i);
    EXPECT_EQ(right.frame().luma.data[0], 10 * i + 1);
    EXPECT_EQ(left.frame().utime, 1'000'000 + i * 33'000);
    EXPECT_EQ(right.frame().captured_ns - left.frame().captured_ns, 700'000);
    EXPECT_EQ(left.frame().sequence, static_cast<unsigned>(i));
  }
  EXPECT_FALSE(log.left->next(1s));
  EXPECT_FALSE(log.right->next(1s));
  EXPECT_EQ(log.left->state(), SourceState::kFinished);
  EXPECT_EQ(log.right->state(), SourceState::kFinished);
}

TEST_F(LogSource, Unpaired_Skipped) {
  write("R_RIGHT_RAW", image_of(900'000, 1));
  write_pair(1'000'000, 10);
  write("R_LEFT_RAW", image_of(1'033'000, 2));
  write_pair(1'066'000, 20);
  write("R_LEFT_RAW", image_of(1'099'000, 3), 10);  // cut off
  write("R_LEFT_RAW", image_of(9'000'000, 4));
  write("OTHER_LEFT_RAW", image_of(1'000'000, 5));
  image_t color = image_of(1'132'000, 6);
  color.pixelformat = 3;
  write("R_LEFT_RAW", color);
  image_t lie = image_of(1'165'000, 7);
  lie.width = 1 << 30;
  write("R_LEFT_RAW", lie);
  LogSources log = open();
  EXPECT_EQ(log.pairs, 2);
  EXPECT_EQ(log.unpaired, 6);
  EXPECT_EQ(log.left->next(1s).frame().luma.data[0], 10);
}

TEST_F(LogSource, Loop_TimesContinue) {
  write_pair(1'000'000, 0);
  write_pair(1'040'000, 1);
  LogSources log = open(false, true);
  std::vector<std::int64_t> utimes;
  for (int i = 0; i < 5; ++i) {
    const FrameLease left = log.left->next(1s), right = log.right->next(1s);
    ASSERT_TRUE(left && right);
    utimes.push_back(left.frame().utime);
  }
  EXPECT_THAT(utimes, testing::ElementsAre(1'000'000, 1'040'000, 1'080'000, 1'120'000, 1'160'000));
}

TEST_F(LogSource, OriginalPace_Kept) {
  write_pair(1'000'000, 0);
  write_pair(1'150'000, 1);
  LogSources log = open(true);
  std::int64_t first_ns = 0;
  {
    const FrameLease left = log.left->next(1s), right = log.right->next(1s);
    ASSERT_TRUE(left && right);
    first_ns = left.frame().captured_ns;
  }
  EXPECT_FALSE(log.left->next(1ms));  // not due yet
  FrameLease left;
  while (!left) left = log.left->next(10ms);
  EXPECT_EQ(left.frame().captured_ns - first_ns, 150'000'000);
  log.right->stop();
  EXPECT_FALSE(log.right->next(10s));
}

TEST_F(LogSource, UnusableLog_ReasonNamed) {
  EXPECT_THAT(error(), HasSubstr("this is no LCM log"));
  write("R_LEFT_RAW", image_of(1, 1));
  EXPECT_THAT(error(),
              HasSubstr("no pair of images on R_LEFT_RAW and R_RIGHT_RAW; record with lcm.raw_images"));
  write("R_RIGHT_RAW", image_of(1, 1, 32, 24));
  EXPECT_THAT(error(), HasSubstr("not all of one size"));
}

// Messages with the fingerprint of image_t whose lengths are wrong.
class HostileLog : public LogSource {
 protected:
  static constexpr std::size_t kSizeOffset = 8 + 8 + 4 * 4;

  static void put(std::vector<std::byte>& bytes, std::size_t at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i)
      bytes.at(at + static_cast<std::size_t>(i)) = std::byte(value >> (24 - 8 * i) & 0xff);
  }
  static void append(std::vector<std::byte>& bytes, std::uint32_t value) {
    bytes.resize(bytes.size() + 4);
    put(bytes, bytes.size() - 4, value);
  }
  static std::vector<std::byte> encoded(const image_t& image) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(image.getEncodedSize()));
    image.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    return bytes;
  }
  /// Returns a message with the given size of the image data.
  static std::vector<std::byte> with_size(std::uint32_t size) {
    std::vector<std::byte> bytes = encoded(image_of(1'000'000, 1));
    put(bytes, kSizeOffset, size);
    return bytes;
  }
  /// Returns a message with the given number of metadata entries and, after it, the length of the first key.
  static std::vector<std::byte> with_metadata(std::uint32_t entries, std::uint32_t key_length) {
    std::vector<std::byte> bytes = encoded(image_of(1'000'000, 1));
    put(bytes, bytes.size() - 4, entries);
    append(bytes, key_length);
    append(bytes, 0);
    return bytes;
  }
  static std::vector<std::vector<std::byte>> messages() {
    constexpr std::uint32_t kMinus1 = 0xffff'ffff, kMin = 0x8000'0000, kMillions = 60'000'000;
    return {with_metadata(1, kMin),       with_metadata(1, 0),
            with_metadata(1, kMinus1),    with_metadata(1, kMillions),
            with_metadata(kMinus1, kMin), with_metadata(kMin, 1),
            with_metadata(kMillions, 1),  with_size(0),
            with_size(kMinus1),           with_size(kMin),
            with_size(kMillions)};
  }
};

TEST_F(HostileLog, OnlyHostileMessages_RefusedInOneSentence) {
  for (const std::vector<std::byte>& bytes : messages()) {
    writer_.write(1'000'000, "R_LEFT_RAW", bytes);
    writer_.write(1'000'000, "R_RIGHT_RAW", bytes);
  }
  EXPECT_EQ(error(),
            file_.string() +
                ": the log has no pair of images on R_LEFT_RAW and R_RIGHT_RAW (22 messages there are not "
                "8-bit gray images); record with lcm.raw_images: true, or set cameras.log.prefix");
}

TEST_F(HostileLog, AmongGoodPairs_Skipped) {
  write_pair(1'000'000, 10);
  for (const std::vector<std::byte>& bytes : messages()) writer_.write(1'000'000, "R_LEFT_RAW", bytes);
  write_pair(1'033'000, 20);
  LogSources log = open();
  EXPECT_EQ(log.pairs, 2);
  EXPECT_EQ(log.unpaired, 11);
}

TEST_F(HostileLog, ExtremeTimes_Refused) {
  for (const std::int64_t utime : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::min(),
                                   std::numeric_limits<std::int64_t>::max()}) {
    writer_.write(1'000'000, "R_LEFT_RAW", encoded(image_of(utime, 1)));
  }
  write_pair(1'000'000, 10);
  LogSources log = open();
  EXPECT_EQ(log.pairs, 1);
  EXPECT_EQ(log.unpaired, 3);
}

}  // namespace
}  // namespace stereod
