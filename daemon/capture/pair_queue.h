// SPDX-License-Identifier: BSD-3-Clause
// Where the frames of the two capture threads meet.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "core/rectify/rectify_map.h"
#include "core/sync/pairing.h"
#include "daemon/capture/frame_source.h"

namespace stereod {

using LeasedPair = FramePair<FrameLease>;

/// The pairing policy (core/sync/pairing.h) behind a lock.
///
/// Threads: two producers, the capture threads, call add() and never block for longer than the lock is held.
/// One consumer at a time, the matching thread, blocks in wait_pair().
///
/// Ownership: the queue holds at most one waiting frame of each camera and one complete pair. A frame that is
/// dropped goes back to its source at once, so nothing queues up and latency never grows. Every lease must
/// end before its source is destroyed: call clear() when the consumer is gone.
///
/// Tolerance: two frames are a pair if their capture times differ by at most the tolerance. It is either
/// fixed (`cameras.max_skew_ms`), or half a frame period (`max_skew_ms: 0`). In the second case the queue
/// starts with half of the configured period and follows the cameras: a camera that falls back to a lower
/// rate reports its period by set_frame_time(), and the tolerance becomes half of the longer one of both
/// periods.
class PairQueue {
 public:
  /// @p tolerance_ns [ns, ≥ 0]. @p half_frame: the tolerance is half a frame period and follows
  /// set_frame_time().
  explicit PairQueue(std::int64_t tolerance_ns, bool half_frame = false)
      : pairing_(tolerance_ns), half_frame_(half_frame) {}

  // For producers.

  /// Takes a frame of one camera. Frames that the policy drops are given back at once.
  void add(Side side, FrameLease frame) noexcept;

  /// Sets the frame period of one camera [ns]; 0 = unknown, which leaves the tolerance as it is.
  void set_frame_time(Side side, std::int64_t frame_ns) noexcept;

  /// Gives the camera's waiting frame back, because the camera has stopped streaming.
  void camera_interrupted(Side side) noexcept;

  /// Tells that one camera delivers no further frames. Closes the queue when both have said so.
  void camera_finished() noexcept;

  // For the consumer.

  /// Blocks until there is a pair and returns the newest one. Returns nothing if the queue is closed and
  /// empty, or if @p cancelled is true; after setting it, call wake_consumer(). A pair that is in the queue
  /// when the consumer is cancelled stays for the next consumer.
  std::optional<LeasedPair> wait_pair(const std::atomic<bool>& cancelled) noexcept;

  /// Blocks until a pair is ready, the queue is closed, or @p timeout [ms, ≥ 0] has passed. Returns the newest
  /// pair, or nothing. For a consumer without a thread of its own.
  std::optional<LeasedPair> wait_pair_for(std::chrono::milliseconds timeout) noexcept;

  /// Returns whether the queue is closed and its last pair was taken.
  bool is_finished() const noexcept;

  /// Returns true while a consumer is blocked and there is no pair.
  bool consumer_waits() const noexcept;

  // For the owner.

  void wake_consumer() noexcept;

  /// Refuses all further frames and ends wait_pair().
  void close() noexcept;

  /// Gives every frame in the queue back.
  void clear() noexcept;

  /// Returns how the latest frame of a camera lay in memory; nothing before its first frame.
  std::optional<SourceLayout> layout(Side side) const noexcept;

  PairingCounts counts() const noexcept;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Pairing<FrameLease> pairing_;
  int cameras_finished_ = 0;
  bool closed_ = false;
  bool consumer_waits_ = false;
  std::optional<SourceLayout> layout_[2];
  const bool half_frame_;
  std::int64_t frame_ns_[2] = {0, 0};
};

}  // namespace stereod
