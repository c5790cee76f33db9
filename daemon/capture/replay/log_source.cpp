#include "daemon/capture/replay/log_source.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/base/file_error.h"
#include "daemon/capture/frame_clock.h"
#include "daemon/lcm/handle.h"
#include "daemon/lcm/limits.h"
#include "daemon/lcm/log.h"
#include "daemon/lcm/pixel_format_codes.h"
#include "stereod/image_t.hpp"

namespace stereod {
namespace {

constexpr std::int64_t kFarthestPartner = 500'000;             // µs between the exposures of a pair
constexpr std::uint64_t kMax_GiB = sizeof(void*) < 8 ? 1 : 4;  // all of it is kept in memory
constexpr std::size_t kFields = 48;                            // bytes of an image_t besides its data

struct LoggedImage {
  std::int64_t utime = 0;
  GrayImage picture;
};
struct LoggedPair {
  LoggedImage left, right;
};

/// The image of a message; nothing if it is not one.
std::optional<LoggedImage> image_of(const std::vector<std::byte>& data) {
  // What the message says of its size is checked before its own code believes it.
  constexpr std::size_t kSizeAt = 8 + 8 + 4 * 4;
  if (data.size() < kFields) return std::nullopt;
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) size = size << 8 | std::to_integer<std::uint32_t>(data[kSizeAt + i]);
  const bool plain = std::all_of(data.end() - 4, data.end(), [](std::byte b) { return b == std::byte{0}; });
  if (size > data.size() || !plain) return std::nullopt;
  image_t m;
  if (m.decode(data.data(), 0, static_cast<int>(data.size())) != static_cast<int>(data.size()))
    return std::nullopt;
  const bool sane = m.pixelformat == kPixelFormatGray && m.width > 0 && m.width <= kMaxImageSide &&
                    m.height > 0 && m.height <= kMaxImageSide && m.row_stride == m.width &&
                    m.size == m.width * m.height;
  if (!sane) return std::nullopt;
  LoggedImage image{m.utime, GrayImage(m.width, m.height)};
  for (int y = 0; y < m.height; ++y) {
    std::copy_n(m.data.data() + std::ptrdiff_t{y} * m.width, m.width, image.picture.row(y));
  }
  return image;
}

/// The image of a list, in the order of time, that is nearest to `utime`; the list is not empty.
std::size_t nearest_to(const std::vector<LoggedImage>& images, std::int64_t utime) {
  const auto after =
      std::lower_bound(images.begin(), images.end(), utime,
                       [](const LoggedImage& image, std::int64_t t) { return image.utime < t; });
  const auto index = static_cast<std::size_t>(after - images.begin());
  if (index == 0) return 0;
  if (index == images.size() || utime - images[index - 1].utime <= images[index].utime - utime)
    return index - 1;
  return index;
}

struct LoggedPairs {
  std::vector<LoggedPair> pairs;
  int unpaired = 0;
};

/// Two images are a pair if each is the other's nearest: one that was lost does not lend its partner to the
/// next.
LoggedPairs paired(std::vector<LoggedImage> left, std::vector<LoggedImage> right) {
  const auto by_time = [](const LoggedImage& a, const LoggedImage& b) { return a.utime < b.utime; };
  std::stable_sort(left.begin(), left.end(), by_time);
  std::stable_sort(right.begin(), right.end(), by_time);
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < left.size() && !right.empty(); ++i) {
    const std::size_t partner = nearest_to(right, left[i].utime);
    const bool near = std::abs(right[partner].utime - left[i].utime) <= kFarthestPartner;
    if (near && nearest_to(left, right[partner].utime) == i) found.emplace_back(i, partner);
  }
  LoggedPairs result;
  result.unpaired = static_cast<int>(left.size() + right.size() - 2 * found.size());
  for (const auto& [i, partner] : found) {
    result.pairs.push_back({std::move(left[i]), std::move(right[partner])});
  }
  return result;
}

LoggedPairs read_pairs(const std::filesystem::path& file, const std::string& prefix) {
  LcmLogReader reader(file);
  std::vector<LoggedImage> left, right;
  int damaged = 0;
  std::uint64_t bytes = 0;
  LogEvent event;
  while (reader.next(event)) {
    const bool is_left = event.channel == prefix + "_LEFT_RAW";
    if (!is_left && event.channel != prefix + "_RIGHT_RAW") continue;
    std::optional<LoggedImage> image = image_of(event.data);
    if (!image) {
      ++damaged;
      continue;
    }
    bytes += event.data.size();
    if (bytes > kMax_GiB << 30) {
      throw FileError(file.string() + ": the log has more than " + std::to_string(kMax_GiB) +
                      " GiB of raw images; cut it into pieces, as "
                      "'stereo-tap record --seconds' makes them");
    }
    (is_left ? left : right).push_back(std::move(*image));
  }
  LoggedPairs result = paired(std::move(left), std::move(right));
  result.unpaired += damaged;
  return result;
}

void check(const LoggedPairs& log, const std::filesystem::path& file, const std::string& prefix) {
  if (log.pairs.empty()) {
    throw FileError(file.string() + ": the log has no pair of images on " + prefix + "_LEFT_RAW and " +
                    prefix + "_RIGHT_RAW; record with lcm.raw_images: true, or set cameras.log.prefix");
  }
  const Size size = log.pairs.front().left.picture.size();
  for (const LoggedPair& pair : log.pairs) {
    if (pair.left.picture.size() == size && pair.right.picture.size() == size) continue;
    throw FileError(file.string() + ": the images of the log are not all of one size");
  }
}

/// What the two sources share.
struct Replay {
  Replay(std::vector<LoggedPair> logged, const LogReplayOptions& replay_options)
      : pairs(std::move(logged)), options(replay_options), clock(0, {{}, {}}) {
    length_us = pairs.back().left.utime - pairs.front().left.utime;
    if (pairs.size() > 1) length_us += length_us / static_cast<std::int64_t>(pairs.size() - 1);
  }

  const std::vector<LoggedPair> pairs;
  const LogReplayOptions options;
  std::int64_t length_us = 0;  // of a loop
  FrameClock clock;            // hands out numbers; none is skipped
  std::mutex mutex;
  std::condition_variable stopped_changed;
  std::optional<std::chrono::steady_clock::time_point> origin;  // when pair 0 was handed out
};

class LogSource final : public FrameSource, private BufferOwner {
 public:
  LogSource(std::shared_ptr<Replay> replay, int camera, LoggedImage LoggedPair::*side)
      : replay_(std::move(replay)), camera_(camera), side_(side) {}

  Size frame_size() const override { return replay_->pairs.front().left.picture.size(); }

  FrameLease next(std::chrono::milliseconds timeout) noexcept override {
    if (state() == SourceState::kFinished) return {};
    if (!tick_) tick_ = replay_->clock.wait(camera_, timeout);
    if (!tick_) return {};
    const auto number = static_cast<std::size_t>(tick_->number);
    if (!replay_->options.loop && number >= replay_->pairs.size()) {
      state_ = SourceState::kFinished;
      replay_->clock.give_back(camera_);
      replay_->clock.stop(camera_);  // the other camera must not wait for this one
      return {};
    }
    const LoggedImage& image = replay_->pairs[number % replay_->pairs.size()].*side_;
    const auto rounds = static_cast<std::int64_t>(number / replay_->pairs.size());
    const LoggedPair& pair = replay_->pairs[number % replay_->pairs.size()];
    Frame frame;
    frame.luma = {image.picture.row(0), image.picture.size(), image.picture.view().stride(), 1};
    frame.utime = image.utime + rounds * replay_->length_us;
    frame.sequence = static_cast<std::uint32_t>(number);
    frame.captured_ns = tick_->captured_ns + (image.utime - pair.left.utime) * 1000;
    if (replay_->options.original_pace && !wait_until_due(frame, timeout)) return {};
    tick_.reset();
    state_ = SourceState::kStreaming;
    return {frame, *this, 0};
  }

  SourceState state() const noexcept override { return state_; }
  void stop() noexcept override {
    {
      const std::lock_guard lock(replay_->mutex);
      stopped_ = true;
    }
    replay_->stopped_changed.notify_all();
    replay_->clock.stop(camera_);
  }

 private:
  /// Sets the frame's time of capture to when it is due; false if it is not due in time.
  bool wait_until_due(Frame& frame, std::chrono::milliseconds timeout) noexcept {
    std::unique_lock lock(replay_->mutex);
    const auto now = std::chrono::steady_clock::now();
    if (!replay_->origin) replay_->origin = now;
    const auto due =
        *replay_->origin + std::chrono::microseconds(frame.utime - replay_->pairs.front().left.utime);
    const auto stopped = [this] { return stopped_; };
    replay_->stopped_changed.wait_until(lock, std::min(due, now + timeout), stopped);
    if (stopped_ || std::chrono::steady_clock::now() < due) return false;
    frame.captured_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(due.time_since_epoch()).count();
    return true;
  }

  void give_back(int /*buffer*/) noexcept override { replay_->clock.give_back(camera_); }

  std::shared_ptr<Replay> replay_;
  int camera_;
  LoggedImage LoggedPair::*side_;
  std::optional<FrameTick> tick_;  // taken from the clock, and not due yet
  bool stopped_ = false;           // under the replay's mutex
  std::atomic<SourceState> state_{SourceState::kWaiting};
};

}  // namespace

LogSources open_log(const std::filesystem::path& file, const LogReplayOptions& options) {
  try {
    LoggedPairs log = read_pairs(file, options.prefix);
    check(log, file, options.prefix);
    LogSources sources;
    sources.pairs = static_cast<int>(log.pairs.size());
    sources.unpaired = log.unpaired;
    const auto replay = std::make_shared<Replay>(std::move(log.pairs), options);
    sources.left = std::make_unique<LogSource>(replay, 0, &LoggedPair::left);
    sources.right = std::make_unique<LogSource>(replay, 1, &LoggedPair::right);
    return sources;
  } catch (const BusError& error) {
    throw FileError(error.what());
  }
}

}  // namespace stereod
