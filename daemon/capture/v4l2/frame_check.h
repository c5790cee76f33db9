// SPDX-License-Identifier: BSD-3-Clause
// Decides which buffers of the driver become frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "daemon/capture/v4l2/pixel_format.h"

namespace stereod::v4l2 {

/// Why a buffer of the driver did not become a frame.
enum class FrameDrop {
  kDriverError,         ///< marked as damaged by the driver
  kEmpty,               ///< contains 0 bytes
  kShort,               ///< contains fewer bytes than the image needs
  kNoJpeg,              ///< does not begin with a JPEG header
  kJpegSize,            ///< JPEG of another size than negotiated
  kJpegDamaged,         ///< JPEG is truncated or corrupt
  kStale,               ///< timestamp far from now
  kTimestampBackwards,  ///< timestamp before that of the previous frame
  kSuperseded,          ///< a newer frame was already there
  kNoRoom,              ///< all images for decoding are on loan
};
inline constexpr std::size_t kFrameDrops = 10;
/// Returns the reason for people: "too short".
std::string_view name_of(FrameDrop drop);
/// Returns false for reasons that are no fault of the frame.
constexpr bool is_damage(FrameDrop drop) {
  return drop != FrameDrop::kSuperseded && drop != FrameDrop::kNoRoom;
}

/// Buffers dropped since the start, by reason.
struct DropCounts {
  std::array<std::int64_t, kFrameDrops> of{};
  std::int64_t& operator[](FrameDrop drop) { return of[static_cast<std::size_t>(drop)]; }
  std::int64_t operator[](FrameDrop drop) const { return of[static_cast<std::size_t>(drop)]; }
};

/// Checks what the driver reports about a buffer, without looking at its content. Returns false and sets @p
/// drop if the buffer cannot hold an image. @p mapped_bytes: the mapped length. @p min_bytes: see
/// min_buffer_bytes().
bool is_complete(const FilledBuffer& buffer, std::size_t mapped_bytes, std::size_t min_bytes,
                 FrameDrop& drop);

/// Converts the driver's timestamps to the start of exposure on CLOCK_MONOTONIC and refuses impossible ones.
class TimestampFilter {
 public:
  /// Prepares for a new stream. @p frame_ns: frame period [ns]. @p exposure_ns: exposure time [ns], 0 =
  /// unknown.
  void reset(std::int64_t frame_ns, std::int64_t exposure_ns) noexcept;

  /// Computes when the exposure of a buffer began. Returns false and sets @p drop if the frame must be
  /// dropped.
  ///
  /// A timestamp of the start of exposure is used as it is. A timestamp of the end of the frame is moved back
  /// by one frame period (the readout time of a rolling shutter) and the exposure time. A timestamp of an
  /// unknown clock is used if it lies within 1 s before and 20 ms after @p now_ns; otherwise @p now_ns, the
  /// time of arrival, replaces it.
  bool start_of_exposure(const FilledBuffer& buffer, std::int64_t now_ns, std::int64_t& start_ns,
                         FrameDrop& drop) noexcept;

 private:
  // After this many frames in a row, a clock that was set back is accepted.
  static constexpr int kMaxBackwards = 5;

  std::int64_t frame_ns_ = 0;
  std::int64_t exposure_ns_ = 0;
  std::int64_t last_ns_ = 0;
  int backwards_ = 0;
};

}  // namespace stereod::v4l2
