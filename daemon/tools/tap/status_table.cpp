// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/tap/status_table.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>

#include "daemon/tools/tap/text_table.h"

namespace stereod::tools {
namespace {

using Align = TextTable::Align;
using Lines = std::vector<std::string>;

constexpr std::size_t kLabelWidth = 16;
constexpr std::size_t kCameraWidth = 29;  // two of them and the labels make 78 columns
constexpr std::size_t kTextWidth = 60;

/// Returns the local time of day of @p utime [µs since the Unix epoch].
std::string time_of_day(std::int64_t utime) {
  const std::time_t seconds = static_cast<std::time_t>(utime / 1000000);
  std::tm local{};
  char text[16];
  if (localtime_r(&seconds, &local) == nullptr || std::strftime(text, sizeof text, "%H:%M:%S", &local) == 0)
    return "-";
  return text;
}

/// Returns text from the network, made printable; a dash for an empty text.
std::string or_dash(const std::string& text) { return text.empty() ? "-" : printable(text); }

std::string number(std::int64_t value) { return std::to_string(value); }

std::string frames(const camera_status_t& camera) {
  return number(camera.frames) + ", " + fixed(camera.fps, 1) + " /s";
}

std::string synchronization(const status_t& s) {
  if (s.sync_state.empty()) return "-";
  return printable(s.sync_state) + ", skew " + fixed(s.sync_skew_ms, 2) + " ms, " + number(s.sync_restarts) +
         " restarts";
}

Lines head(const status_t& s) {
  TextTable table({{.min_width = kLabelWidth}, {.max_width = kTextWidth}});
  table.add_row({"state", or_dash(s.state)});
  table.add_row({"reason", or_dash(s.reason)});
  table.add_row({"synchronization", synchronization(s)});
  table.add_row({"matcher", or_dash(s.matcher)});
  table.add_row({"program", "stereod " + or_dash(s.version) + ", up " + duration_in_words(s.uptime_s) +
                                ", status of " + time_of_day(s.utime)});
  return table.lines();
}

std::string last_fault(const camera_status_t& camera, std::int64_t now_us) {
  if (camera.last_fault_utime <= 0) return "-";
  const double ago_s = (static_cast<double>(now_us) - static_cast<double>(camera.last_fault_utime)) * 1e-6;
  return duration_in_words(ago_s) + " ago: " + or_dash(camera.last_fault);
}

Lines cameras(const camera_status_t& l, const camera_status_t& r, std::int64_t now_us) {
  TextTable table({{.min_width = kLabelWidth}, {.max_width = kCameraWidth}, {.max_width = kCameraWidth}});
  table.add_row({"camera", or_dash(l.name), or_dash(r.name)});
  table.add_row({"  state", or_dash(l.state), or_dash(r.state)});
  table.add_row({"  reason", or_dash(l.reason), or_dash(r.reason)});
  table.add_row({"  last fault", last_fault(l, now_us), last_fault(r, now_us)});
  table.add_row({"  note", or_dash(l.note), or_dash(r.note)});
  table.add_row({"  configured", or_dash(l.device), or_dash(r.device)});
  table.add_row({"  device", or_dash(l.connected), or_dash(r.connected)});
  table.add_row({"  format", or_dash(l.format), or_dash(r.format)});
  table.add_row({"  brightness", fixed(l.mean_brightness, 1), fixed(r.mean_brightness, 1)});
  table.add_row({"  frames", frames(l), frames(r)});
  table.add_row({"  sequence gaps", number(l.sequence_gaps), number(r.sequence_gaps)});
  table.add_row({"  decode errors", number(l.decode_errors), number(r.decode_errors)});
  table.add_row({"  incomplete", number(l.frames_incomplete), number(r.frames_incomplete)});
  table.add_row({"  bad timestamps", number(l.frames_bad_timestamp), number(r.frames_bad_timestamp)});
  table.add_row({"  superseded", number(l.frames_superseded), number(r.frames_superseded)});
  table.add_row({"  reconnects", number(l.reconnects), number(r.reconnects)});
  return table.lines();
}

Lines times(const status_t& s) {
  const TextTable::Column value{.align = Align::kRight, .min_width = 7};
  TextTable table({{.min_width = kLabelWidth}, value, value, value});
  table.add_row({"ms, last second", "median", "95 %", "max"});
  table.add_row(
      {"  latency", fixed(s.latency_ms_median, 2), fixed(s.latency_ms_p95, 2), fixed(s.latency_ms_max, 2)});
  table.add_row({"  matching", fixed(s.match_ms_median, 2)});
  table.add_row({"  skew", fixed(s.skew_ms_median, 2), fixed(s.skew_ms_p95, 2), fixed(s.skew_ms_max, 2)});
  return table.lines();
}

void add_if_known(TextTable& table, const std::string& label, bool is_known, const std::string& value,
                  const std::string& unit) {
  if (is_known) {
    table.add_row({label, value, unit});
  } else {
    table.add_row({label, "not known"});
  }
}

Lines load(const status_t& s) {
  TextTable table({{.min_width = 16}, {.align = Align::kRight, .min_width = 7}, {}});
  table.add_row({"frames in", fixed(s.fps_in, 1), "/s"});
  table.add_row({"frames out", fixed(s.fps_out, 1), "/s"});
  table.add_row({"pacing", s.paced != 0 ? "on" : "off"});
  table.add_row({"measured", fixed(100 * s.measured_fraction, 1), "%"});
  table.add_row({"filled", fixed(100 * s.filled_fraction, 1), "%"});
  add_if_known(table, "no evidence", s.no_evidence_fraction >= 0, fixed(100 * s.no_evidence_fraction, 1),
               "%");
  add_if_known(table, "epipolar error", s.epipolar_points > 0, fixed(s.epipolar_error_px, 2), "px");
  table.add_row({"CPU", fixed(s.cpu_percent, 1), "%"});
  table.add_row({"memory", fixed(s.rss_mb, 1), "MB"});
  return table.lines();
}

Lines counts(const status_t& s) {
  const TextTable::Column value{.align = Align::kRight, .min_width = 8};
  TextTable table({{.min_width = 18}, value, {.min_width = 0}, {.min_width = 27}, value});
  table.add_row({"since the start", "", "", "dropped"});
  table.add_row({"  pairs made", number(s.pairs_made), "", "  superseded by a newer pair",
                 number(s.pairs_dropped_superseded)});
  table.add_row({"  frames published", number(s.frames_published), "", "  no partner near in time",
                 number(s.frames_dropped_no_partner)});
  table.add_row(
      {"  publish errors", number(s.publish_errors), "", "  time jump", number(s.frames_dropped_time_jump)});
  return table.lines();
}

void append(Lines& to, const Lines& more) { to.insert(to.end(), more.begin(), more.end()); }

/// Joins two tables side by side.
Lines beside(const Lines& left, const Lines& right) {
  TextTable table({{.min_width = kLabelWidth + kCameraWidth + 2}, {}});
  for (std::size_t i = 0; i < std::max(left.size(), right.size()); ++i) {
    table.add_row({i < left.size() ? left[i] : "", i < right.size() ? right[i] : ""});
  }
  return table.lines();
}

}  // namespace

std::vector<std::string> status_lines(const status_t& status) {
  Lines lines = head(status);
  lines.emplace_back();
  append(lines, cameras(status.left, status.right, status.utime));
  lines.emplace_back();
  append(lines, beside(times(status), load(status)));
  lines.emplace_back();
  append(lines, counts(status));
  return lines;
}

std::string duration_in_words(double seconds) {
  if (!(seconds >= 0 && seconds < 1e15)) return "-";
  const auto s = static_cast<long long>(seconds);
  char text[64];
  if (s >= 86400) {
    std::snprintf(text, sizeof text, "%lld d %02lld h", s / 86400, s / 3600 % 24);
  } else if (s >= 3600) {
    std::snprintf(text, sizeof text, "%lld h %02lld min", s / 3600, s / 60 % 60);
  } else if (s >= 60) {
    std::snprintf(text, sizeof text, "%lld min %02lld s", s / 60, s % 60);
  } else {
    std::snprintf(text, sizeof text, "%lld s", s);
  }
  return text;
}

}  // namespace stereod::tools
