// SPDX-License-Identifier: BSD-3-Clause
// Decoding and pairing the images of a log.
#include "daemon/capture/replay/log_pairs.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "daemon/base/file_error.h"
#include "daemon/lcm/handle.h"
#include "daemon/lcm/limits.h"
#include "daemon/lcm/log.h"
#include "daemon/lcm/message_decoder.h"
#include "daemon/lcm/pixel_format_codes.h"

namespace stereod {
namespace {

constexpr std::int64_t kMaxSkew = 500'000;  // [µs] between the exposures of a pair
constexpr std::int64_t kMaxUtime =
    4'102'444'800'000'000;  // [µs] year 2100; differences in ns fit into 64 bits
constexpr std::uint64_t kMaxGibibytes = sizeof(void*) < 8 ? 1 : 4;  // all images are kept in memory

/// Returns the image of a message, nothing if the bytes are not an 8-bit gray image.
std::optional<LoggedImage> decode_image(const std::vector<std::byte>& data) {
  image_t message;
  if (!decode_message(std::span(data), message)) return std::nullopt;
  const bool valid = message.utime >= 0 && message.utime <= kMaxUtime &&
                     message.pixelformat == kPixelFormatGray && message.width > 0 &&
                     message.width <= kMaxImageSide && message.height > 0 &&
                     message.height <= kMaxImageSide && message.row_stride == message.width &&
                     message.size == message.width * message.height;
  if (!valid) return std::nullopt;
  LoggedImage logged{message.utime, GrayImage(message.width, message.height)};
  for (int y = 0; y < message.height; ++y) {
    std::copy_n(message.data.data() + std::ptrdiff_t{y} * message.width, message.width, logged.image.row(y));
  }
  return logged;
}

/// Returns the index of the image nearest to @p utime. @p images is sorted by time and not empty.
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

/// Pairs images that are each other's nearest. If an image is missing in the log, its partner is not paired
/// with the next one.
LoggedPairs pair_nearest(std::vector<LoggedImage> left, std::vector<LoggedImage> right) {
  const auto by_time = [](const LoggedImage& a, const LoggedImage& b) { return a.utime < b.utime; };
  std::stable_sort(left.begin(), left.end(), by_time);
  std::stable_sort(right.begin(), right.end(), by_time);
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < left.size() && !right.empty(); ++i) {
    const std::size_t partner = nearest_to(right, left[i].utime);
    const bool near = std::abs(right[partner].utime - left[i].utime) <= kMaxSkew;
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
  int refused = 0;
  std::uint64_t bytes = 0;
  LogEvent event;
  while (reader.next(event)) {
    const bool is_left = event.channel == prefix + "_LEFT_RAW";
    if (!is_left && event.channel != prefix + "_RIGHT_RAW") continue;
    std::optional<LoggedImage> image = decode_image(event.data);
    if (!image) {
      ++refused;
      continue;
    }
    bytes += event.data.size();
    if (bytes > kMaxGibibytes << 30) {
      throw FileError(file.string() + ": the log has more than " + std::to_string(kMaxGibibytes) +
                      " GiB of raw images; record shorter logs with 'stereo-tap record --seconds'");
    }
    (is_left ? left : right).push_back(std::move(*image));
  }
  LoggedPairs log = pair_nearest(std::move(left), std::move(right));
  log.unpaired += refused;
  if (log.pairs.empty()) {
    const std::string why =
        refused > 0 ? " (" + std::to_string(refused) + " messages there are not 8-bit gray images)" : "";
    throw FileError(file.string() + ": the log has no pair of images on " + prefix + "_LEFT_RAW and " +
                    prefix + "_RIGHT_RAW" + why +
                    "; record with lcm.raw_images: true, or set cameras.log.prefix");
  }
  return log;
}

void require_one_size(const LoggedPairs& log, const std::filesystem::path& file) {
  const Size size = log.pairs.front().left.image.size();
  for (const LoggedPair& pair : log.pairs) {
    if (pair.left.image.size() == size && pair.right.image.size() == size) continue;
    throw FileError(file.string() + ": the images of the log are not all of one size");
  }
}

}  // namespace

LoggedPairs read_logged_pairs(const std::filesystem::path& file, const std::string& prefix) {
  try {
    LoggedPairs log = read_pairs(file, prefix);
    require_one_size(log, file);
    return log;
  } catch (const BusError& error) {
    throw FileError(error.what());
  }
}

}  // namespace stereod
