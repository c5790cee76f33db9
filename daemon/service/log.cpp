// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/log.h"

#include <poll.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace stereod {
namespace {

// Writes the priority that syslog and systemd use for a level.
class SystemdPriority final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm& /*time*/,
              spdlog::memory_buf_t& out) override {
    out.push_back(priority_of(message.level));
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<SystemdPriority>();
  }

 private:
  static char priority_of(spdlog::level::level_enum level) {
    switch (level) {
      case spdlog::level::critical:
        return '2';
      case spdlog::level::err:
        return '3';
      case spdlog::level::warn:
        return '4';
      case spdlog::level::info:
        return '6';
      default:
        return '7';
    }
  }
};

// Writes to stderr but never waits for its reader: drops a line that would block, and reports the number of
// dropped lines before the next line that passes.
class UnblockedStderr final : public spdlog::sinks::base_sink<std::mutex> {
 private:
  // A pipe that is ready accepts at least this much at once (PIPE_BUF on Linux).
  static constexpr std::size_t kMaxLine = 4096;

  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    if (dropped_ > 0 && write_line(std::to_string(dropped_) + " log lines dropped (stderr blocked)\n")) {
      dropped_ = 0;
    }
    if (!write_line({line.data(), line.size()})) ++dropped_;
  }
  void flush_() override {}

  static bool write_line(const std::string& line) {
    pollfd ready{STDERR_FILENO, POLLOUT, 0};
    if (poll(&ready, 1, 0) != 1 || (ready.revents & POLLOUT) == 0) return false;
    return write(STDERR_FILENO, line.data(), std::min(line.size(), kMaxLine)) > 0;
  }

  long dropped_ = 0;
};

// systemd passes the device and inode of the journal's socket, so that a program can tell whether stderr was
// redirected.
bool read_by_journal() {
  const char* stream = std::getenv("JOURNAL_STREAM");
  struct stat status {};
  if (stream == nullptr || fstat(STDERR_FILENO, &status) != 0) return false;
  return stream == std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

}  // namespace

void set_up_log(const std::string& level) {
  auto logger = std::make_shared<spdlog::logger>("stereod", std::make_shared<UnblockedStderr>());
  if (!read_by_journal()) {
    logger->set_pattern("%H:%M:%S.%e %l: %v");
  } else {
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<SystemdPriority>('*').set_pattern("<%*>%v");
    logger->set_formatter(std::move(formatter));
  }
  spdlog::set_default_logger(std::move(logger));
  set_log_level(level);
}

void set_log_level(const std::string& level) {
  spdlog::default_logger()->set_level(spdlog::level::from_str(level));
}

}  // namespace stereod
