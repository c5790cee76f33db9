// Where the capture threads' frames meet.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>

#include "core/rectify/rectify_map.h"
#include "core/sync/pairing.h"
#include "daemon/capture/frame_source.h"

namespace stereod {

using LeasedPair = FramePair<FrameLease>;

/// The pairing policy behind a lock: capture threads bring frames, one thread takes pairs. Nothing waits here
/// but the taker.
class PairQueue {
 public:
  /// `tolerance_ns`: of the pairing. `half_frames`: it is half a frame, and changes when a camera's rate
  /// does.
  explicit PairQueue(std::int64_t tolerance_ns, bool half_frames = false)
      : pairing_(tolerance_ns), half_frames_(half_frames) {}

  /// The time from one frame of a camera to its next; 0: not known.
  void set_frame_time(Side side, std::int64_t frame_ns) noexcept;

  /// A camera has stopped streaming: its frame that waits for a partner is given back.
  void camera_interrupted(Side side) noexcept;

  /// Takes a frame of one camera. Frames it drops are given back at once.
  void add(Side side, FrameLease frame) noexcept;

  /// One camera will bring no more frames; after both have said so, the desk is closed.
  void camera_finished() noexcept;

  /// No frame is taken any more.
  void close() noexcept;

  /// The newest pair; waits for one. Nothing once the desk is closed and the last pair taken, or once the
  /// taker is called off: after `cancelled` was set and wake_consumer() called. A pair that lies here then
  /// stays for the next taker.
  std::optional<LeasedPair> wait_pair(const std::atomic<bool>& cancelled) noexcept;
  void wake_consumer() noexcept;

  /// Blocks until a pair is ready, the queue is closed, or @p timeout [ms, ≥ 0] has passed. Returns the newest pair, or
  /// nothing. For a consumer without a thread of its own.
  std::optional<LeasedPair> wait_pair_for(std::chrono::milliseconds timeout) noexcept;

  /// Returns whether the queue is closed and its last pair was taken.
  bool is_finished() const noexcept;

  /// Somebody waits for a pair and there is none.
  bool consumer_waits() const noexcept;

  /// How the latest frame of a camera lay in memory; nothing before the first.
  std::optional<SourceLayout> layout(Side side) const noexcept;

  /// Gives back every frame that still lies here.
  void clear() noexcept;

  PairingCounts counts() const noexcept;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Pairing<FrameLease> pairing_;
  int cameras_finished_ = 0;
  bool closed_ = false;
  bool consumer_waits_ = false;
  std::optional<SourceLayout> layout_[2];
  const bool half_frames_;
  std::int64_t frame_ns_[2] = {0, 0};
};

}  // namespace stereod
