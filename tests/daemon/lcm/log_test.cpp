// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/eventlog.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "daemon/lcm/handle.h"
#include "daemon/tools/tap/log_summary.h"
#include "tests/support/random_images.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

class LcmLog : public testing::Test {
 protected:
  void write_three() {
    LcmLogWriter writer(file_);
    writer.write(1'000'000, "STEREO_A", bytes_of("first"));
    writer.write(1'500'000, "STEREO_B", bytes_of(""));
    writer.write(2'000'000, "STEREO_A", bytes_of(std::string(100'000, 'x')));
    writer.finish();
  }
  std::string content() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void overwrite(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }

  TemporaryDirectory directory_;
  const std::filesystem::path file_ = directory_ / "test.lcm";
};

TEST_F(LcmLog, Written_ReadBack) {
  write_three();
  LcmLogReader reader(file_);
  LogEvent event;
  ASSERT_TRUE(reader.next(event));
  EXPECT_EQ(event.utime, 1'000'000);
  EXPECT_EQ(event.channel, "STEREO_A");
  EXPECT_EQ(event.data, bytes_of("first"));
  ASSERT_TRUE(reader.next(event));
  EXPECT_TRUE(event.data.empty());
  ASSERT_TRUE(reader.next(event));
  EXPECT_EQ(event.data.size(), 100'000U);
  EXPECT_FALSE(reader.next(event));
  EXPECT_EQ(reader.damaged_places(), 0);
}

// Reader and writer are compatible with LCM's own.
TEST_F(LcmLog, Format_OfLcmTools) {
  write_three();
  lcm_eventlog_t* log = lcm_eventlog_create(file_.c_str(), "r");
  int events = 0;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log)) {
    if (events++ == 0) {
      EXPECT_EQ(event->timestamp, 1'000'000);
      EXPECT_EQ(std::string(static_cast<char*>(event->data), 5), "first");
    }
    lcm_eventlog_free_event(event);
  }
  lcm_eventlog_destroy(log);
  EXPECT_EQ(events, 3);
  log = lcm_eventlog_create(file_.c_str(), "w");
  char channel[] = "CH", data[] = "data";
  lcm_eventlog_event_t event{};
  event.timestamp = 77;
  event.channellen = 2;
  event.datalen = 4;
  event.channel = channel;
  event.data = data;
  lcm_eventlog_write_event(log, &event);
  lcm_eventlog_destroy(log);
  LcmLogReader reader(file_);
  LogEvent read;
  ASSERT_TRUE(reader.next(read));
  EXPECT_EQ(read.utime, 77);
  EXPECT_EQ(read.channel, "CH");
  EXPECT_EQ(read.data, bytes_of("data"));
}

TEST_F(LcmLog, NoLog_Error) {
  const auto error_text = [&] {
    try {
      const LcmLogReader reader(file_);
    } catch (const BusError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(error_text(), testing::HasSubstr("cannot be opened: No such file"));
  overwrite("");
  EXPECT_THAT(error_text(), testing::HasSubstr("this is no LCM log"));
  overwrite("# some text\n");
  EXPECT_THAT(error_text(), testing::HasSubstr("this is no LCM log"));
  EXPECT_THROW(LcmLogWriter(directory_ / "no" / "such" / "directory.lcm"), BusError);
}

TEST_F(LcmLog, Damage_Skipped) {
  write_three();
  std::string bytes = content();
  bytes[24] = 0x7F;  // the first message claims a length of 2 GB
  overwrite(bytes);
  LcmLogReader reader(file_);
  LogEvent event;
  ASSERT_TRUE(reader.next(event));
  EXPECT_EQ(event.channel, "STEREO_B");
  EXPECT_TRUE(reader.next(event));
  EXPECT_FALSE(reader.next(event));
  EXPECT_EQ(reader.damaged_places(), 1);
}

TEST_F(LcmLog, Truncated_ReadToTheCut) {
  write_three();
  const std::string bytes = content();
  for (std::size_t size = 4; size < bytes.size(); size += size < 200 ? 1 : 997) {
    overwrite(bytes.substr(0, size));
    LcmLogReader reader(file_);
    LogEvent event;
    int events = 0;
    while (reader.next(event)) ++events;
    EXPECT_LT(events, 3) << size;
    EXPECT_LE(reader.damaged_places(), 1) << size;
  }
}

TEST_F(LcmLog, RandomDamage_Survives) {
  write_three();
  const std::string good = content();
  Random random(4);
  for (int round = 0; round < 300; ++round) {
    std::string bytes = good;
    for (int i = 0; i < 20; ++i) {
      bytes[static_cast<std::size_t>(random.between(4, 120))] = static_cast<char>(random.between(0, 255));
    }
    overwrite(bytes);
    LcmLogReader reader(file_);
    LogEvent event;
    int events = 0;
    while (reader.next(event)) ++events;
    EXPECT_LE(events, 3);
  }
}

TEST(LogSummary, Messages_CountedByChannel) {
  tools::LogSummary summary;
  for (int i = 0; i < 11; ++i) summary.add("STEREO_FRAME", i * 100'000, 100);
  summary.add("STEREO_\x1b[2J", 1'000'000, 2'500'000);
  EXPECT_EQ(summary.messages(), 12);
  EXPECT_EQ(summary.seconds(), 1);
  EXPECT_THAT(summary.lines(), testing::ElementsAre("STEREO_?[2J    1 messages   1.0 /s  2.50 MB",
                                                    "STEREO_FRAME  11 messages  11.0 /s  0.00 MB",
                                                    "in 1.0 s      12 messages  12.0 /s  2.50 MB"));
}

}  // namespace
}  // namespace stereod
