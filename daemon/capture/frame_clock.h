// SPDX-License-Identifier: BSD-3-Clause
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
  std::int64_t number = 0;  ///< counts from 0; a gap stands for frames that the consumer came too late for
  std::int64_t captured_ns = 0;  ///< CLOCK_MONOTONIC; the same for all cameras, plus the camera's offset
};

/// The clock that recorded or rendered cameras share: frame n of each camera has the same number and the same
/// capture time. Two modes:
///
///   fps > 0  Frame n is due at origin + n / fps. The deadlines are absolute, so nothing drifts. The origin
///            is the first call of wait() by any camera. A late consumer gets the newest frame that is due,
///            never an older one.
///   fps = 0  As fast as the consumer gives frames back. A camera gets its next frame when its previous one
///            was given back and every other camera has taken the previous one: one frame of each camera is
///            on loan, no frame is skipped, and no camera is ahead by more than one frame. The capture time
///            of frame n is when the first camera takes it.
///
/// A source calls wait() in next(), lends frame `number`, and calls give_back() when the lease ends. After
/// construction nothing allocates or throws.
class FrameClock {
 public:
  /// @p fps [Hz, 0…1000]. @p offsets: for each camera, how much later it exposes and delivers its frames; the
  /// index is the camera's number.
  /// @throws std::invalid_argument if @p fps is out of range.
  FrameClock(double fps, const std::vector<std::chrono::nanoseconds>& offsets);
  FrameClock(const FrameClock&) = delete;
  FrameClock& operator=(const FrameClock&) = delete;

  /// Blocks until the next frame of @p camera is due, at most @p timeout. Returns nothing after the timeout
  /// or once the camera was stopped. Called by one thread for each camera.
  std::optional<FrameTick> wait(int camera, std::chrono::milliseconds timeout) noexcept;

  /// Records that a frame of @p camera is no longer on loan. Any thread.
  void give_back(int camera) noexcept;

  /// Makes every wait() of @p camera return at once; the other cameras no longer wait for it. Any thread.
  void stop(int camera) noexcept;

 private:
  using Time = std::chrono::steady_clock::time_point;  // CLOCK_MONOTONIC

  struct Camera {
    std::chrono::nanoseconds offset{};
    std::int64_t next = 0;  // the next frame number it may get
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
  std::chrono::nanoseconds period_{};      // 0 = as fast as frames come back
  std::chrono::nanoseconds max_offset_{};  // ≥ 0
  std::optional<Time> origin_;
  Time free_captures_[2];  // fps = 0: capture times of frames newest_ and newest_ − 1, indexed by parity
  std::int64_t newest_ = -1;
};

}  // namespace stereod
