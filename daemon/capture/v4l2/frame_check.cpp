#include "daemon/capture/v4l2/frame_check.h"

#include <limits>

namespace stereod {
namespace {

constexpr std::int64_t kOldest = 1'000'000'000;  // v4l2loopback hands out what lay in a buffer for hours
constexpr std::int64_t kFuture = 20'000'000;     // uvcvideo's estimate may run ahead a little

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
      return "no JPEG";
    case FrameDrop::kJpegSize:
      return "a JPEG of another size";
    case FrameDrop::kJpegDamaged:
      return "a damaged JPEG";
    case FrameDrop::kStale:
      return "stamped far from now";
    case FrameDrop::kTimestampBackwards:
      return "stamped before the last";
    case FrameDrop::kSuperseded:
      return "superseded by a newer one";
    case FrameDrop::kNoRoom:
      return "not needed: all images are on loan";
  }
  return "?";
}

bool is_complete(const FilledBuffer& buffer, std::size_t mapped, std::size_t least, FrameDrop& drop) {
  if (buffer.error) {
    drop = FrameDrop::kDriverError;
  } else if (buffer.bytes == 0) {
    drop = FrameDrop::kEmpty;
  } else if (buffer.bytes < least || buffer.bytes > mapped || mapped < least) {
    drop = FrameDrop::kShort;
  } else {
    return true;
  }
  return false;
}

void TimestampFilter::begin(std::int64_t frame_ns, std::int64_t exposure_ns) noexcept {
  frame_ns_ = frame_ns;
  exposure_ns_ = exposure_ns;
  last_ns_ = std::numeric_limits<std::int64_t>::min();
  backwards_ = 0;
}

bool TimestampFilter::start_of_exposure(const FilledBuffer& buffer, std::int64_t now_ns,
                                        std::int64_t& start_ns, FrameDrop& drop) noexcept {
  const bool near = buffer.timestamp_ns >= now_ns - kOldest && buffer.timestamp_ns <= now_ns + kFuture;
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

}  // namespace stereod
