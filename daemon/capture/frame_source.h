// SPDX-License-Identifier: BSD-3-Clause
// The seam between cameras and the pipeline: a FrameSource lends the frames of one camera.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/luma_view.h"

namespace stereod {

/// One frame of one camera.
struct Frame {
  LumaView luma;
  std::int64_t captured_ns = 0;  ///< start of exposure, CLOCK_MONOTONIC
  std::uint32_t sequence =
      0;                   ///< the camera's own counter; a gap stands for frames that were lost or dropped
  std::int64_t utime = 0;  ///< exposure [µs since the Unix epoch] if the source knows it (a log), else 0
};

/// Takes a buffer back when the last user of a frame is done.
class BufferOwner {
 public:
  virtual ~BufferOwner() = default;
  virtual void give_back(int buffer) noexcept = 0;
};

/// A frame on loan. Its memory is valid until the lease is destroyed, which gives the buffer back to its
/// owner. A lease must end before its source is destroyed.
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

  /// Returns true while a frame is on loan.
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

/// What a source is doing. Rendered and recorded sources go waiting → streaming → finished; real cameras use
/// the other states (state machine: v4l2/v4l2_camera.h).
enum class SourceState {
  kWaiting,    ///< has not delivered a frame yet
  kAbsent,     ///< the camera is not plugged in
  kOpening,    ///< the camera is being set up and has not delivered a frame yet
  kStreaming,  ///< delivers frames
  kStalled,    ///< the camera is set up but delivers no frames; its stream is restarted until it does
  kLost,       ///< the camera streamed, then its driver failed
  kFinished,   ///< the recording has been played to its end: there are no further frames
};

/// Returns the word of the status message: waiting, absent, opening, streaming, stalled, lost, finished.
std::string_view name_of(SourceState state);

/// The state and the counters of a source, for the status message. Counters start at 0 and never decrease.
struct SourceReport {
  SourceState state = SourceState::kWaiting;
  std::string reason;  ///< why the source does not stream; empty while it does
  std::string device;  ///< the device in use; empty if there is none
  std::string format;  ///< "MJPG 640×480 at 30 Hz"; empty if there is none
  std::string note;    ///< a problem that does not stop the stream, such as a control that could not be set
  std::string last_fault;           ///< why it last stopped streaming
  std::int64_t last_fault_ns = 0;   ///< when, CLOCK_MONOTONIC; 0 = never
  std::int64_t reconnects = 0;      ///< times it streamed again
  std::int64_t sequence_gaps = 0;   ///< frames that the camera counted and the driver never delivered
  std::int64_t decode_errors = 0;   ///< frames dropped: JPEG could not be decoded
  std::int64_t incomplete = 0;      ///< frames dropped: empty, too short, or marked as damaged by the driver
  std::int64_t bad_timestamps = 0;  ///< frames dropped: timestamp far from now, or before the previous one
  std::int64_t superseded = 0;      ///< frames dropped: a newer one was there, or no image was free
};

/// One camera: real, recorded or rendered.
///
/// Threads: next() and frame_time_ns() belong to one thread, the camera's own. state(), report() and the end
/// of a lease may come from any thread. stop() may come from any thread, once; it makes every next() return
/// at once.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Returns the size of every frame of this source.
  virtual Size frame_size() const = 0;

  /// Blocks until the next frame is there, at most @p timeout. Returns an empty lease if no frame came in
  /// time, the source was stopped or it has finished (see state()). Neither allocates nor throws.
  virtual FrameLease next(std::chrono::milliseconds timeout) noexcept = 0;

  virtual SourceState state() const noexcept = 0;
  virtual void stop() noexcept = 0;

  /// Allocates; not for the per-frame path.
  virtual SourceReport report() const;

  /// Returns the present frame period [ns], 0 if it is the configured one.
  virtual std::int64_t frame_time_ns() const noexcept { return 0; }
};

}  // namespace stereod
