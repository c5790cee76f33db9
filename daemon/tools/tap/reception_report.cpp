// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/tap/reception_report.h"

#include <algorithm>
#include <cmath>

#include "daemon/tools/tap/text_table.h"

namespace stereod::tools {
namespace {

/// Returns the smallest of the @p sorted values that @p share of them do not exceed.
double nearest_rank(const std::vector<double>& sorted, double share) {
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

void add_spread(TextTable& table, const std::string& label, const std::vector<double>& values) {
  const Spread s = spread_of(values);
  if (values.empty()) return table.add_row({label, "-", "-", "-"});
  table.add_row({label, fixed(s.median, 2), fixed(s.p95, 2), fixed(s.max, 2)});
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {nearest_rank(values, 0.5), nearest_rank(values, 0.95), values.back()};
}

double Reception::fps() const {
  if (frames < 2 || last_utime <= first_utime) return 0;
  return static_cast<double>(frames - 1) * 1e6 / static_cast<double>(last_utime - first_utime);
}

std::vector<std::string> report_lines(const Reception& reception) {
  const ReceptionCounts& c = reception.counts;
  const auto number = [](std::int64_t value) { return std::to_string(value); };
  const TextTable::Column value{.align = TextTable::Align::kRight, .min_width = 9};
  TextTable table({{.min_width = 28}, value, value, value});
  table.add_row({"", "expected", "received", "lost"});
  table.add_row({"frames", number(c.frames_expected), number(c.frames_complete),
                 number(c.frames_incomplete + c.frames_missing)});
  table.add_row({"rows", number(c.rows_expected), number(c.rows_received), number(c.rows_lost)});
  table.add_row({});
  table.add_row({"latency, ms", "median", "95 %", "max"});
  add_spread(table, "exposure to last row sent", reception.latency_ms);
  add_spread(table, "exposure to frame complete", reception.arrival_ms);

  std::vector<std::string> lines = table.lines();
  lines.emplace_back();
  lines.push_back(fixed(reception.fps(), 1) + " frames/s");
  const auto mention = [&lines](std::int64_t count, const std::string& what) {
    if (count > 0) lines.push_back(std::to_string(count) + " " + what);
  };
  mention(c.frames_missing, "of the lost frames: no message arrived");
  mention(c.rows_duplicate, "duplicate rows");
  mention(c.messages_late, "late messages");
  mention(c.messages_ignored - c.messages_of_another, "invalid messages ignored");
  mention(c.messages_of_another,
          "messages of another stereod on the same channels: give each its own lcm.prefix");
  mention(c.restarts, "restarts of the frame numbers: stereod was restarted, or two share an lcm.prefix");
  return lines;
}

}  // namespace stereod::tools
