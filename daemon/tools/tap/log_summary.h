// SPDX-License-Identifier: BSD-3-Clause
// Summarizes the messages of a log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace stereod::tools {

/// Counts messages by channel.
class LogSummary {
 public:
  void add(std::string_view channel, std::int64_t utime, std::size_t bytes);

  std::int64_t messages() const { return messages_; }
  /// Returns the time from the first message to the last [s]; 0 for fewer than two messages or if time went backwards.
  double seconds() const;
  /// Returns the messages, rate and size of each channel, then the total and its duration.
  std::vector<std::string> lines() const;

 private:
  struct Channel {
    std::int64_t messages = 0;
    std::int64_t bytes = 0;
  };
  std::map<std::string, Channel, std::less<>> channels_;
  std::int64_t messages_ = 0;
  std::int64_t first_utime_ = 0, last_utime_ = 0;
};

}  // namespace stereod::tools
