// The seam between cameras and the pipeline: whoever can lend frames is a frame source.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/base/image.h"
#include "core/base/luma_view.h"

namespace stereod {

/// One frame of one camera.
struct Frame {
  LumaView luma;
  std::int64_t captured_ns = 0;  ///< CLOCK_MONOTONIC at the start of exposure
  std::uint32_t sequence = 0;    ///< the camera's own count; a gap is frames that were lost or dropped
  std::int64_t utime = 0;  ///< µs since the Unix epoch, if the source knows better than captured_ns; else 0
};

/// Who takes a buffer back when the last user of a frame is done.
class BufferOwner {
 public:
  virtual void give_back(int buffer) noexcept = 0;

 protected:
  ~BufferOwner() = default;
};

/// A frame on loan: its memory is valid until the lease is destroyed, which gives the buffer back. Leases end
/// before their source does.
class FrameLease {
 public:
  FrameLease() = default;
  FrameLease(const Frame& frame, BufferOwner& owner, int buffer)
      : frame_(frame), owner_(&owner), buffer_(buffer) {}
  FrameLease(FrameLease&& other) noexcept
      : frame_(other.frame_), owner_(std::exchange(other.owner_, nullptr)), buffer_(other.buffer_) {}
  FrameLease& operator=(FrameLease&& other) noexcept {
    if (this != &other) {
      end();
      frame_ = other.frame_;
      owner_ = std::exchange(other.owner_, nullptr);
      buffer_ = other.buffer_;
    }
    return *this;
  }
  ~FrameLease() { end(); }

  explicit operator bool() const { return owner_ != nullptr; }
  const Frame& frame() const { return frame_; }
  void end() noexcept {
    if (BufferOwner* owner = std::exchange(owner_, nullptr)) owner->give_back(buffer_);
  }

 private:
  Frame frame_;
  BufferOwner* owner_ = nullptr;
  int buffer_ = 0;
};

/// What a camera is doing, for the status message.
enum class SourceState {
  kWaiting,    ///< no frames yet, or none any more; it keeps trying
  kStreaming,  ///< frames come
  kFinished,   ///< a recording played to its end: no frame will ever come again
};

/// How a source is, for people and for the status message.
struct SourceReport {
  std::string state;       ///< waiting, streaming or finished; of a real camera: see CameraState
  std::string reason;      ///< why it does not stream; empty when it does
  std::string device;      ///< the device it is now; empty if none
  std::string format;      ///< what it gives: "MJPG 640×480 at 30/s"
  std::string note;        ///< what is worth knowing all the same, such as a control that did not take
  std::string last_fault;  ///< the last reason it did not stream for
  std::int64_t last_fault_ns = 0;   ///< when, CLOCK_MONOTONIC; 0: never
  std::int64_t reconnects = 0;      ///< times it streamed again
  std::int64_t sequence_gaps = 0;   ///< frames that the camera counted and that never came here
  std::int64_t decode_errors = 0;   ///< frames dropped: JPEGs that could not be decoded
  std::int64_t incomplete = 0;      ///< frames dropped: empty, too short, or marked as damaged by the driver
  std::int64_t bad_timestamps = 0;  ///< frames dropped: stamped in a time that cannot be
  std::int64_t superseded = 0;      ///< frames dropped: a newer one was there already
};

/// One camera: real, recorded or rendered. next() is called by one thread, the camera's own; give_back() by
/// any; stop() by any, once, and makes next() return at once from then on.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The size of every frame it lends.
  virtual Size frame_size() const = 0;

  /// Waits for the next frame. An empty lease means: none within the time-out, stopped, or finished; ask
  /// state(). Allocates nothing and throws nothing.
  virtual FrameLease next(std::chrono::milliseconds timeout) noexcept = 0;

  virtual SourceState state() const noexcept = 0;
  virtual void stop() noexcept = 0;

  /// Any thread; not on the per-frame path.
  virtual SourceReport report() const;

  /// The time from one frame to the next as the camera has it now; 0: as configured. The camera's thread.
  virtual std::int64_t frame_time_ns() const noexcept { return 0; }
};

}  // namespace stereod
