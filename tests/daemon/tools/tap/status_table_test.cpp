// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/tap/status_table.h"

#include <gtest/gtest.h>

#include <string>

#include "daemon/tools/tap/reception_report.h"
#include "daemon/tools/tap/text_table.h"

namespace stereod::tools {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(Printable, ControlCharacters_Replaced) {
  EXPECT_EQ(printable("plain text, \xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80"),
            "plain text, \xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80");
  EXPECT_EQ(printable("\x1b[2Jgone\r\n\t\x7f"), "?[2Jgone????");
  EXPECT_EQ(printable("\xC2\x9B"
                      "2J"),
            "??2J");  // an escape sequence in one character
  EXPECT_EQ(printable("\xFF\xC3"), "??");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "?");
}

TEST(Wrapped, LongText_BrokenAtSpaces) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(wrapped("", 5), Lines{""});
  EXPECT_EQ(wrapped("one two three", 8), (Lines{"one two", "three"}));
  EXPECT_EQ(wrapped("one two", 7), Lines{"one two"});
  EXPECT_EQ(wrapped("abcdefgh", 3), (Lines{"abc", "def", "gh"}));
  EXPECT_EQ(wrapped("\xC3\xA4\xC3\xA4\xC3\xA4", 2), (Lines{"\xC3\xA4\xC3\xA4", "\xC3\xA4"}));
}

TEST(TextTable, Rows_Aligned) {
  TextTable table({{}, {.align = TextTable::Align::kRight, .min_width = 4}});
  table.add_row({"a", "1"});
  table.add_row({"long", "12345"});
  table.add_row({"end"});
  EXPECT_EQ(joined(table.lines()), "a         1\nlong  12345\nend\n");
}

/// Returns a camera status with the counts @p count + 1, + 2, …
camera_status_t camera(const std::string& name, const std::string& device, const std::string& state,
                       const std::string& reason, double fps, std::int64_t count) {
  camera_status_t c{};
  c.name = name;
  c.device = device;
  c.connected = "now " + device;
  c.format = "fmt-" + name;
  c.state = state;
  c.reason = reason;
  c.note = "note-" + name;
  c.fps = fps;
  c.mean_brightness = static_cast<double>(count) / 10 + 0.9;
  c.frames = ++count;
  c.sequence_gaps = ++count;
  c.decode_errors = ++count;
  c.reconnects = ++count;
  c.frames_incomplete = ++count;
  c.frames_bad_timestamp = ++count;
  c.frames_superseded = ++count;
  return c;
}

TEST(StatusTable, Status_ShowsEveryField) {
  status_t s{};
  s.utime = 1'700'000'000'000'000;
  s.state = "degraded";
  s.reason = "the right camera sends nothing";
  s.version = "1.2.3";
  s.matcher = "block simd avx2, 2 workers";
  s.uptime_s = 3725;
  s.fps_in = 30.1;
  s.fps_out = 29.2;
  s.frames_published = 1001;
  s.pairs_made = 1002;
  s.pairs_dropped_superseded = 1003;
  s.frames_dropped_no_partner = 1004;
  s.frames_dropped_time_jump = 1005;
  s.publish_errors = 1006;
  s.skew_ms_median = -1.11;
  s.skew_ms_p95 = 2.22;
  s.skew_ms_max = 7.77;
  s.sync_state = "given up";
  s.sync_skew_ms = 8.88;
  s.sync_restarts = 1007;
  s.latency_ms_median = 3.33;
  s.latency_ms_p95 = 4.44;
  s.latency_ms_max = 5.55;
  s.match_ms_median = 6.66;
  s.measured_fraction = 0.777;
  s.filled_fraction = 0.123;
  s.no_evidence_fraction = 0.091;
  s.paced = 1;
  s.cpu_percent = 88.8;
  s.rss_mb = 99.9;
  s.epipolar_error_px = 3.21;
  s.epipolar_points = 150;
  s.left = camera("left", "/dev/a", "streaming", "", 31.3, 2000);
  s.right = camera("right", "/dev/b", "waiting", "unplugged", 32.4, 3000);
  s.right.last_fault = "pulled out";
  s.right.last_fault_utime = s.utime - 42'000'000;
  const std::vector<std::string> lines = status_lines(s);
  const std::string text = joined(lines);
  for (const char* expected : {"degraded",   "the right camera sends nothing",
                               "1.2.3",      "block simd avx2, 2 workers",
                               "1 h 02 min", "30.1",
                               "29.2",       "1001",
                               "1002",       "1003",
                               "1004",       "1005",
                               "1006",       "-1.11",
                               "2.22",       "3.33",
                               "4.44",       "5.55",
                               "6.66",       "77.7",
                               "88.8",       "99.9",
                               "left",       "right",
                               "/dev/a",     "/dev/b",
                               "streaming",  "waiting",
                               "unplugged",  "31.3",
                               "2001",       "2002",
                               "2003",       "2004",
                               "32.4",       "3001",
                               "3002",       "3003",
                               "3004",       "7.77",
                               "given up",   "8.88",
                               "1007",       "2005",
                               "2006",       "2007",
                               "3005",       "3006",
                               "3007",       "200.9",
                               "300.9",      "now /dev/a",
                               "now /dev/b", "fmt-left",
                               "fmt-right",  "note-left",
                               "note-right", "42 s ago: pulled out",
                               "3.21",       "12.3",
                               "9.1",        " on\n"}) {
    EXPECT_NE(text.find(expected), std::string::npos) << expected << " is missing from\n" << text;
  }
  EXPECT_EQ(lines[0].substr(0, 5), "state");
  EXPECT_EQ(lines[1].substr(0, 6), "reason");
  for (const std::string& line : lines) EXPECT_LE(display_width(line), 80U) << line;
}

TEST(StatusTable, UnknownFraction_NotKnown) {
  status_t s{};
  s.no_evidence_fraction = -1;
  EXPECT_NE(joined(status_lines(s)).find("not known"), std::string::npos);
  s.no_evidence_fraction = 0;
  s.epipolar_points = 10;
  EXPECT_EQ(joined(status_lines(s)).find("not known"), std::string::npos);
}

TEST(StatusTable, HostileStatus_StaysATable) {
  status_t s{};
  s.utime = INT64_MAX;
  s.reason = std::string(500, 'x');
  s.reason += "\x1b[0m\n";
  s.uptime_s = -1;
  s.fps_in = 1e300 * 1e300;
  s.left.device = std::string(300, 'y');
  s.left.frames = INT64_MIN;
  for (const std::string& line : status_lines(s)) {
    EXPECT_LE(display_width(line), 80U) << line;
    EXPECT_EQ(line, printable(line));
  }
}

TEST(Duration, Seconds_InWords) {
  EXPECT_EQ(duration_in_words(7.9), "7 s");
  EXPECT_EQ(duration_in_words(125), "2 min 05 s");
  EXPECT_EQ(duration_in_words(3725), "1 h 02 min");
  EXPECT_EQ(duration_in_words(90061), "1 d 01 h");
  EXPECT_EQ(duration_in_words(-1), "-");
}

TEST(Spread, Values_NearestRank) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  const Spread s = spread_of(values);
  EXPECT_EQ(s.median, 50);
  EXPECT_EQ(s.p95, 95);
  EXPECT_EQ(s.max, 100);
  EXPECT_EQ(spread_of({4}).median, 4);
  EXPECT_EQ(spread_of({}).max, 0);
}

TEST(Reception, Losses_Reported) {
  Reception reception;
  reception.counts = {.frames_expected = 10,
                      .frames_complete = 8,
                      .frames_incomplete = 1,
                      .frames_missing = 1,
                      .rows_expected = 4800,
                      .rows_received = 4300,
                      .rows_lost = 500};
  reception.frames = 8;
  reception.first_utime = 1'000'000;
  reception.last_utime = 1'700'000;
  EXPECT_TRUE(reception.anything_lost());
  EXPECT_DOUBLE_EQ(reception.fps(), 10);
  const std::string text = joined(report_lines(reception));
  EXPECT_NE(text.find("10.0 frames/s"), std::string::npos) << text;
  EXPECT_NE(text.find("4300"), std::string::npos) << text;
}

}  // namespace
}  // namespace stereod::tools
