// What is in a log, as a person wants to know it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace stereod {

/// Counts messages by channel.
class LogSummary {
 public:
  void add(std::string_view channel, std::int64_t utime, std::size_t bytes);

  std::int64_t messages() const { return messages_; }
  /// From the first message to the last, s; 0 if there are fewer than two, or if time went backwards.
  double seconds() const;
  /// Channels with messages, a second and size; then the sum, with the time it took.
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

}  // namespace stereod
