// Which buffers are images.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "daemon/capture/v4l2/pixel_format.h"

namespace stereod {

/// Why a buffer of the driver did not become a frame.
enum class FrameDrop {
  kDriverError,         ///< the driver marked it as damaged
  kEmpty,               ///< nothing in it
  kShort,               ///< fewer bytes than the image needs
  kNoJpeg,              ///< does not begin like a JPEG
  kJpegSize,            ///< a JPEG of another size than agreed
  kJpegDamaged,         ///< truncated, or rubbish inside
  kStale,               ///< its stamp is far from now
  kTimestampBackwards,  ///< stamped earlier than the frame before it
  kSuperseded,          ///< a newer frame was there already
  kNoRoom,              ///< every decoded image is still on loan
};
inline constexpr std::size_t kFrameDrops = 10;
std::string_view name_of(FrameDrop drop);
/// False for a good frame that was not needed.
constexpr bool is_damage(FrameDrop drop) {
  return drop != FrameDrop::kSuperseded && drop != FrameDrop::kNoRoom;
}

/// How many buffers were dropped since the start, by reason.
struct DropCounts {
  std::array<std::int64_t, kFrameDrops> of{};
  std::int64_t& operator[](FrameDrop drop) { return of[static_cast<std::size_t>(drop)]; }
  std::int64_t operator[](FrameDrop drop) const { return of[static_cast<std::size_t>(drop)]; }
};

/// Judges a buffer by what the driver says of it, before its bytes are looked at. `mapped`: the buffer's
/// length. True if it may be a image; else `drop` says why not.
bool is_complete(const FilledBuffer& buffer, std::size_t mapped, std::size_t least, FrameDrop& drop);

/// Turns the drivers' stamps into the start of exposure on CLOCK_MONOTONIC, and refuses stamps that cannot
/// be.
class TimestampFilter {
 public:
  /// `frame_ns`: the time of one frame. `exposure_ns`: 0 if the camera does not say.
  void begin(std::int64_t frame_ns, std::int64_t exposure_ns) noexcept;

  /// When the exposure began. A stamp of the end of the frame is put back by one frame, the time a rolling
  /// shutter takes to read out, and the exposure. Without a known clock a stamp counts only if it is close to
  /// now; else now is taken, the time the frame came. False if the frame must be dropped.
  bool start_of_exposure(const FilledBuffer& buffer, std::int64_t now_ns, std::int64_t& start_ns,
                         FrameDrop& drop) noexcept;

 private:
  // A clock that was set back for good must not stop a camera for good.
  static constexpr int kMaxBackwards = 5;

  std::int64_t frame_ns_ = 0;
  std::int64_t exposure_ns_ = 0;
  std::int64_t last_ns_ = 0;
  int backwards_ = 0;
};

}  // namespace stereod
