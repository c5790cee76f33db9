// LCM's log files, as lcm-logger writes them, read and written without trusting them.
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

/// One message of a log.
struct LogEvent {
  std::int64_t utime = 0;  ///< when it was received, µs since the Unix epoch
  std::string channel;
  std::vector<std::byte> data;
};

struct LogFileCloser {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using LogFile = std::unique_ptr<std::FILE, LogFileCloser>;

/// Reads a log from its beginning, one message after the other.
class LcmLogReader {
 public:
  /// Throws BusError with a sentence if the file cannot be opened or does not begin like a log.
  explicit LcmLogReader(const std::filesystem::path& file);

  /// False at the end. After a damaged place it goes on with the next message; see damaged_places().
  bool next(LogEvent& event);

  /// How often something in the file was no message: a log that was cut off in the middle has one such place.
  int damaged_places() const { return damaged_places_; }

  static constexpr std::size_t kMaxMessage = 64 << 20;  ///< bytes; more is taken for damage

 private:
  bool read_head(std::span<std::uint8_t> head);
  bool find_sync();

  LogFile file_;
  int damaged_places_ = 0;
};

/// Writes a log that LCM's own tools read.
class LcmLogWriter {
 public:
  /// Replaces the file. Throws BusError with a sentence if that cannot be done.
  explicit LcmLogWriter(const std::filesystem::path& file);

  /// Throws BusError if it cannot be written (a full disk).
  void write(std::int64_t utime, std::string_view channel, std::span<const std::byte> data);
  /// Everything is in the file. Throws BusError.
  void finish();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  LogFile file_;
  std::int64_t events_ = 0;
};

}  // namespace stereod
