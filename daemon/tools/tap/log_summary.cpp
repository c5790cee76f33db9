// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/tap/log_summary.h"

#include "daemon/tools/tap/text_table.h"

namespace stereod::tools {
namespace {

std::string megabytes(std::int64_t bytes) { return fixed(static_cast<double>(bytes) / 1e6, 2) + " MB"; }

}  // namespace

void LogSummary::add(std::string_view channel, std::int64_t utime, std::size_t bytes) {
  auto found = channels_.find(channel);
  if (found == channels_.end()) found = channels_.emplace(std::string(channel), Channel()).first;
  ++found->second.messages;
  found->second.bytes += static_cast<std::int64_t>(bytes);
  if (messages_++ == 0) first_utime_ = utime;
  last_utime_ = utime;
}

double LogSummary::seconds() const {
  const double seconds = (static_cast<double>(last_utime_) - static_cast<double>(first_utime_)) * 1e-6;
  return seconds > 0 ? seconds : 0;
}

std::vector<std::string> LogSummary::lines() const {
  const TextTable::Column number{.align = TextTable::Align::kRight};
  TextTable table({{}, number, number, number});
  const auto rate = [&](std::int64_t messages) {
    return seconds() > 0 ? fixed(static_cast<double>(messages) / seconds(), 1) + " /s" : std::string("-");
  };
  std::int64_t bytes = 0;
  for (const auto& [name, channel] : channels_) {
    table.add_row({printable(name), std::to_string(channel.messages) + " messages", rate(channel.messages),
                   megabytes(channel.bytes)});
    bytes += channel.bytes;
  }
  table.add_row({"in " + fixed(seconds(), 1) + " s", std::to_string(messages_) + " messages", rate(messages_),
                 megabytes(bytes)});
  return table.lines();
}

}  // namespace stereod::tools
