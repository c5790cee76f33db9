// When the frames of a recording or of a rendered scene are due.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

namespace stereod {

/// A frame that may be delivered now.
struct FrameTick {
  std::int64_t number = 0;  ///< counts from 0; a gap means the consumer came too late for the frames between
  std::int64_t captured_ns = 0;  ///< CLOCK_MONOTONIC; the same for every camera, plus the camera's own offset
};

/// The one time that the cameras of a rig which are not real share, so that frame n of each carries the same
/// number and the same capture time. It has two ways to go:
///   fps > 0: frame n is due at origin + n / fps, an absolute deadline, so nothing drifts. The origin is the
///     first call of wait(), by any camera. Whoever asks late gets the newest frame that is due, never an old
///     one.
///   fps = 0: as fast as frames come back. A camera gets its next frame when its last one was given back and
///     every other camera has taken its own last one: one frame a camera is on loan, none is ever skipped,
///     and no camera runs ahead by more than one. Frame n is captured when the first camera takes it.
///
/// A source calls wait() with its camera's number in next(), lends what frame `number` is, and calls
/// give_back() when the lease ends. After construction nothing here allocates or throws.
class FrameClock {
 public:
  /// `fps` 0…1000 frames a second. `offsets`: one entry for each camera, how much later than the others it
  /// exposes and delivers its frames; its place in the list is the camera's number. Throws
  /// std::invalid_argument.
  FrameClock(double fps, const std::vector<std::chrono::nanoseconds>& offsets);
  FrameClock(const FrameClock&) = delete;
  FrameClock& operator=(const FrameClock&) = delete;

  /// Waits until the next frame of `camera` is due, but no longer than `timeout`; nothing if the time ran out
  /// or the camera was stopped. One thread a camera calls this.
  std::optional<FrameTick> wait(int camera, std::chrono::milliseconds timeout) noexcept;

  /// The frame that `camera` had on loan is free again. Any thread.
  void give_back(int camera) noexcept;

  /// Ends a wait() of `camera` at once, and every one from now on; the other cameras wait for it no longer.
  /// Any thread.
  void stop(int camera) noexcept;

 private:
  using Time = std::chrono::steady_clock::time_point;  // CLOCK_MONOTONIC

  struct Camera {
    std::chrono::nanoseconds offset{};
    std::int64_t next = 0;  // the lowest frame number it may still get
    int on_loan = 0;
    bool stopped = false;
  };

  std::optional<FrameTick> wait_paced(Camera& camera, Time deadline,
                                      std::unique_lock<std::mutex>& lock) noexcept;
  std::optional<FrameTick> wait_free(Camera& camera, Time deadline,
                                     std::unique_lock<std::mutex>& lock) noexcept;
  bool may_take_next(const Camera& camera) const noexcept;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Camera> cameras_;
  std::chrono::nanoseconds period_{};          // 0: as fast as frames come back
  std::chrono::nanoseconds largest_offset_{};  // ≥ 0
  std::optional<Time> origin_;
  Time free_captures_[2];  // fps = 0: when frames number `newest_` and `newest_` - 1 were captured, by parity
  std::int64_t newest_ = -1;
};

}  // namespace stereod
