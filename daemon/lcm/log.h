// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes LCM's log files. The reader does not trust their content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stereod {

/// One message in a log.
struct LogEvent {
  std::int64_t utime = 0;  ///< when it was received [µs since the Unix epoch]
  std::string channel;
  std::vector<std::byte> data;
};

struct LogFileCloser {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using LogFile = std::unique_ptr<std::FILE, LogFileCloser>;

/// Reads the messages of a log in order.
class LcmLogReader {
 public:
  /// @throws BusError if the file cannot be opened or does not start like a log.
  explicit LcmLogReader(const std::filesystem::path& file);

  /// Reads the next message; skips damaged places. Returns false at the end.
  bool next(LogEvent& event);

  /// Returns how many damaged places were skipped. A truncated log has one.
  int damaged_places() const { return damaged_places_; }

  static constexpr std::size_t kMaxMessage = 64 << 20;  ///< [bytes]; a larger one counts as damage

 private:
  bool read_head(std::span<std::uint8_t> head);
  bool find_sync();

  LogFile file_;
  int damaged_places_ = 0;
};

/// Writes a log that LCM's own tools can read.
class LcmLogWriter {
 public:
  /// Replaces the file.
  /// @throws BusError if the file cannot be opened.
  explicit LcmLogWriter(const std::filesystem::path& file);

  /// Appends a message received at @p utime [µs since the Unix epoch].
  /// @throws BusError if the file cannot be written (a full disk).
  void write(std::int64_t utime, std::string_view channel, std::span<const std::byte> data);
  /// Flushes everything to the file.
  /// @throws BusError if the file cannot be written.
  void finish();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  LogFile file_;
  std::int64_t events_ = 0;
};

}  // namespace stereod
