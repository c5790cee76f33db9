// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lcm/log.h"

#include <array>
#include <cerrno>
#include <cstring>

#include "daemon/lcm/handle.h"

namespace stereod {
namespace {

// The head of a message, big-endian: this word, the number (8 bytes) and the time (8) of the message, the
// lengths of channel and data (4 each).
constexpr std::array<std::uint8_t, 4> kSync{0xED, 0xA1, 0xDA, 0x01};
constexpr std::size_t kHead = 28;
constexpr std::size_t kMaxChannel = 1000;

std::uint64_t big_endian(const std::uint8_t* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

void put_big_endian(std::uint8_t* bytes, int count, std::uint64_t value) {
  for (int i = count - 1; i >= 0; --i, value >>= 8) bytes[i] = static_cast<std::uint8_t>(value & 0xFF);
}

}  // namespace

LcmLogReader::LcmLogReader(const std::filesystem::path& file) : file_(std::fopen(file.c_str(), "rbe")) {
  if (!file_) throw BusError(file.string() + ": the log cannot be opened: " + std::strerror(errno), false);
  std::array<std::uint8_t, 4> begin{};
  if (std::fread(begin.data(), 1, begin.size(), file_.get()) != begin.size() || begin != kSync) {
    throw BusError(file.string() + ": this is no LCM log (lcm-logger and 'stereo-tap record' write them)",
                   true);
  }
  std::rewind(file_.get());
}

bool LcmLogReader::next(LogEvent& event) {
  std::array<std::uint8_t, kHead> head{};
  while (read_head(head)) {
    const auto channel = static_cast<std::size_t>(big_endian(&head[20], 4));
    const auto data = static_cast<std::size_t>(big_endian(&head[24], 4));
    const bool plausible = channel >= 1 && channel <= kMaxChannel && data <= kMaxMessage;
    if (plausible) {
      event.utime = static_cast<std::int64_t>(big_endian(&head[12], 8));
      event.channel.resize(channel);
      event.data.resize(data);
      if (std::fread(event.channel.data(), 1, channel, file_.get()) == channel &&
          (data == 0 || std::fread(event.data.data(), 1, data, file_.get()) == data)) {
        return true;
      }
    }
    ++damaged_places_;
    if (!find_sync()) return false;
  }
  return false;
}

/// Reads the next head; skips damaged places. Returns false at the end of the file.
bool LcmLogReader::read_head(std::span<std::uint8_t> head) {
  while (true) {
    const std::size_t got = std::fread(head.data(), 1, head.size(), file_.get());
    if (got == 0) return false;
    if (got == head.size() && std::equal(kSync.begin(), kSync.end(), head.begin())) return true;
    ++damaged_places_;
    if (got < head.size() || std::fseek(file_.get(), 1 - static_cast<long>(got), SEEK_CUR) != 0 ||
        !find_sync()) {
      return false;
    }
  }
}

/// Seeks to the next sync word. Returns false if there is none.
bool LcmLogReader::find_sync() {
  std::size_t matched = 0;
  for (int c = std::fgetc(file_.get()); c != EOF; c = std::fgetc(file_.get())) {
    if (c == kSync[matched]) {
      ++matched;
    } else {
      matched = c == kSync[0] ? 1 : 0;
    }
    if (matched == kSync.size())
      return std::fseek(file_.get(), -static_cast<long>(kSync.size()), SEEK_CUR) == 0;
  }
  return false;
}

LcmLogWriter::LcmLogWriter(const std::filesystem::path& file)
    : path_(file), file_(std::fopen(file.c_str(), "wbe")) {
  if (!file_) fail();
}

void LcmLogWriter::write(std::int64_t utime, std::string_view channel, std::span<const std::byte> data) {
  std::array<std::uint8_t, kHead> head{};
  std::copy(kSync.begin(), kSync.end(), head.begin());
  put_big_endian(&head[4], 8, static_cast<std::uint64_t>(events_++));
  put_big_endian(&head[12], 8, static_cast<std::uint64_t>(utime));
  put_big_endian(&head[20], 4, channel.size());
  put_big_endian(&head[24], 4, data.size());
  const bool written = std::fwrite(head.data(), 1, head.size(), file_.get()) == head.size() &&
                       std::fwrite(channel.data(), 1, channel.size(), file_.get()) == channel.size() &&
                       (data.empty() || std::fwrite(data.data(), 1, data.size(), file_.get()) == data.size());
  if (!written) fail();
}

void LcmLogWriter::finish() {
  if (std::fflush(file_.get()) != 0) fail();
}

void LcmLogWriter::fail() const {
  throw BusError(path_.string() + ": the log cannot be written: " + std::strerror(errno), false);
}

}  // namespace stereod
