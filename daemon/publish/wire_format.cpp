// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/wire_format.h"

#include <algorithm>

#include "daemon/lcm/limits.h"
#include "daemon/publish/depth_publisher.h"

namespace stereod {
namespace {

constexpr int kHeaderAllowance = 256;  // channel name and the other fields of the message [bytes]
constexpr int kMaxRowBytes = kMaxDatagram - kHeaderAllowance;
// With fewer rows more messages are lost (docs/loss.md), with more rows the first ones arrive later.
constexpr int kDefaultRows = 16;
// Slow cameras need no more pacing, and a stop waits for it [s].
constexpr double kMaxPacing_s = 0.1;
constexpr double kAssumedFps = 30;  // where the rate is not limited

}  // namespace

int WireFormat::bytes_per_value() const {
  return (min_disparity + disparities - 1) * units_per_pixel < 0xFF ? 1 : 2;
}

int WireFormat::row_bytes(int width) const {
  const int disparity = width * bytes_per_value() + (width + 7) / 8;
  return with_depth ? std::max(disparity, width * DepthPublisher::kBytesPerValue) : disparity;
}

WireFormat wire_format(const Config& config, Size published, const std::string& calibration_id) {
  WireFormat format;
  format.prefix = config.lcm.prefix;
  format.calibration_id = calibration_id;
  format.min_disparity = config.matcher.min_disparity;
  format.disparities = config.matcher.disparities;
  format.units_per_pixel = config.matcher.units_per_pixel();
  format.with_depth = config.publish.depth;
  format.rows_per_message =
      config.lcm.rows_per_message.value_or(default_rows_per_message(format, published.width));
  const double fps = config.cameras.fps > 0 ? config.cameras.fps : kAssumedFps;
  format.pacing_s = std::min(config.lcm.pacing / fps, kMaxPacing_s);
  return format;
}

int default_rows_per_message(const WireFormat& format, int width) {
  return std::min(kDefaultRows, kMaxRowBytes / format.row_bytes(width));
}

std::optional<std::string> wire_problem(const WireFormat& format, Size published) {
  const int row_bytes = format.row_bytes(published.width);
  if (format.rows_per_message * row_bytes <= kMaxRowBytes) return std::nullopt;
  return "found " + std::to_string(format.rows_per_message) + ", allowed 1…" +
         std::to_string(kMaxRowBytes / row_bytes) + ": a row has " + std::to_string(row_bytes) +
         " bytes, a message holds " + std::to_string(kMaxRowBytes);
}

}  // namespace stereod
