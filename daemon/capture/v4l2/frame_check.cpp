// SPDX-License-Identifier: BSD-3-Clause
// Checks of buffers and timestamps.
#include "daemon/capture/v4l2/frame_check.h"

#include <limits>

namespace stereod::v4l2 {
namespace {

constexpr std::int64_t kMaxAge = 1'000'000'000;  // v4l2loopback hands out buffers that are hours old
constexpr std::int64_t kMaxLead = 20'000'000;    // uvcvideo's estimate may lie slightly ahead

}  // namespace

std::string_view name_of(FrameDrop drop) {
  switch (drop) {
    case FrameDrop::kDriverError:
      return "marked as damaged by the driver";
    case FrameDrop::kEmpty:
      return "empty";
    case FrameDrop::kShort:
      return "too short";
    case FrameDrop::kNoJpeg:
      return "not a JPEG";
    case FrameDrop::kJpegSize:
      return "a JPEG of another size";
    case FrameDrop::kJpegDamaged:
      return "a damaged JPEG";
    case FrameDrop::kStale:
      return "timestamped far from now";
    case FrameDrop::kTimestampBackwards:
      return "timestamped before the previous frame";
    case FrameDrop::kSuperseded:
      return "superseded by a newer one";
    case FrameDrop::kNoRoom:
      return "dropped because all images are on loan";
  }
  return "?";
}

bool is_complete(const FilledBuffer& buffer, std::size_t mapped_bytes, std::size_t min_bytes,
                 FrameDrop& drop) {
  if (buffer.error) {
    drop = FrameDrop::kDriverError;
  } else if (buffer.bytes == 0) {
    drop = FrameDrop::kEmpty;
  } else if (buffer.bytes < min_bytes || buffer.bytes > mapped_bytes || mapped_bytes < min_bytes) {
    drop = FrameDrop::kShort;
  } else {
    return true;
  }
  return false;
}

void TimestampFilter::reset(std::int64_t frame_ns, std::int64_t exposure_ns) noexcept {
  frame_ns_ = frame_ns;
  exposure_ns_ = exposure_ns;
  last_ns_ = std::numeric_limits<std::int64_t>::min();
  backwards_ = 0;
}

bool TimestampFilter::start_of_exposure(const FilledBuffer& buffer, std::int64_t now_ns,
                                        std::int64_t& start_ns, FrameDrop& drop) noexcept {
  const bool near = buffer.timestamp_ns >= now_ns - kMaxAge && buffer.timestamp_ns <= now_ns + kMaxLead;
  if (!near && buffer.timestamp_monotonic) {
    drop = FrameDrop::kStale;
    return false;
  }
  start_ns = near ? buffer.timestamp_ns : now_ns;
  if (!near || !buffer.timestamp_start) start_ns -= frame_ns_ + exposure_ns_;
  if (start_ns < last_ns_ && ++backwards_ < kMaxBackwards) {
    drop = FrameDrop::kTimestampBackwards;
    return false;
  }
  backwards_ = 0;
  last_ns_ = start_ns;
  return true;
}

}  // namespace stereod::v4l2
