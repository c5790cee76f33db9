// SPDX-License-Identifier: BSD-3-Clause
// The buffers of an open camera, and the frames that arrive in them.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "daemon/capture/frame_source.h"
#include "daemon/capture/v4l2/camera_fault.h"
#include "daemon/capture/v4l2/frame_check.h"
#include "daemon/capture/v4l2/image_pool.h"
#include "daemon/capture/v4l2/luma_decoder.h"
#include "daemon/capture/v4l2/stream_setup.h"
#include "daemon/capture/v4l2/video_device.h"

namespace stereod::v4l2 {

/// Streams frames from one camera and lends them without copying where the format allows it.
///
/// Life: open() sets the camera up, start() queues the buffers and starts the stream, newest() fetches
/// frames, stop() stops the stream, close() returns everything to the driver. Start and stop may alternate.
/// close() requires that no buffer is on loan (see on_loan()); frames on loan stay valid after stop().
///
/// Threads: everything belongs to the camera's thread, except give_back(), drops() and frames_missed(), which
/// may be called from any thread. Nothing is allocated between start() and stop().
class CameraStream final : public BufferOwner {
 public:
  /// @p system must outlive the stream. @throws std::bad_alloc
  CameraStream(VideoSystem& system, Size size);
  ~CameraStream() override;
  CameraStream(const CameraStream&) = delete;
  CameraStream& operator=(const CameraStream&) = delete;

  /// Sets the camera up and maps its buffers. Returns nothing on success; after a failure the stream is
  /// closed.
  std::optional<CameraFault> open(const StreamOptions& options);
  /// Queues every buffer that is not on loan and starts the stream. @p exposure_ns: see
  /// TimestampFilter::reset().
  std::optional<CameraFault> start(std::int64_t exposure_ns);
  /// Returns the descriptor to wait on for frames; -1 while closed.
  int descriptor() const noexcept { return device_.descriptor(); }

  /// Empties the driver's queue and returns the newest whole frame, an empty lease if there is none. If the
  /// driver failed, now or when a buffer was given back, sets @p error to an errno value and @p stage to the
  /// failed call; otherwise sets @p error to 0.
  FrameLease newest(int& error, SetupStage& stage) noexcept;

  void stop() noexcept;
  bool on_loan() noexcept;
  void close() noexcept;

  VideoDevice& device() noexcept { return device_; }
  const StreamInfo& info() const { return info_; }
  /// Returns the frame period [ns]; 0 before open().
  std::int64_t frame_time_ns() const noexcept {
    return info_.fps > 0 ? static_cast<std::int64_t>(1e9 / info_.fps) : 0;
  }

  /// Returns the number of buffers dequeued since start(), usable or not.
  std::int64_t buffers_seen() const noexcept { return buffers_seen_; }
  /// Returns the number of buffers dequeued since newest() last returned a frame, or since start().
  std::int64_t buffers_since_frame() const noexcept { return buffers_since_frame_; }
  /// Returns what was wrong with the last damaged frame.
  FrameDrop last_damage() const noexcept { return last_damage_; }

  DropCounts drops() const noexcept;
  /// Returns the number of frames that the camera counted and the driver never delivered, since construction.
  std::int64_t frames_missed() const noexcept { return frames_missed_; }

  void give_back(int buffer) noexcept override;

 private:
  // The pipeline may hold 3 frames of one camera (waiting, in a pair, being matched); the driver needs 2 or
  // more.
  static constexpr std::uint32_t kDriverBuffers = 6;

  std::optional<CameraFault> map_buffers(const std::string& node);
  bool dequeue_newest(FilledBuffer& newest, std::int64_t& start_ns, int& error, SetupStage& stage) noexcept;
  FrameLease lend_in_place(const FilledBuffer& buffer, Frame frame) noexcept;
  FrameLease lend_decoded(const FilledBuffer& buffer, Frame frame, int& error) noexcept;
  void requeue(std::uint32_t index, int& error) noexcept;
  void count_missed(std::uint32_t sequence) noexcept;
  void count(FrameDrop drop) noexcept;

  VideoSystem& system_;
  VideoDevice device_;
  StreamInfo info_;
  std::vector<std::span<const std::uint8_t>> buffers_;
  JpegLumaDecoder jpeg_;
  ImagePool images_;
  TimestampFilter timestamps_;
  std::int64_t buffers_seen_ = 0;
  std::int64_t buffers_since_frame_ = 0;
  FrameDrop last_damage_{};
  std::uint32_t next_sequence_ = 0;
  std::atomic<std::int64_t> frames_missed_{0};

  mutable std::mutex mutex_;  // guards the members below
  bool started_ = false;
  std::vector<bool> buffer_on_loan_;
  int give_back_error_ = 0;
  DropCounts drops_;
};

}  // namespace stereod::v4l2
