// SPDX-License-Identifier: BSD-3-Clause
// Deadlines and turns of recorded or rendered cameras.
#include "daemon/capture/frame_clock.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace stereod {

namespace {

using std::chrono::nanoseconds;

// Longer waits are shortened to this, so that no sum of times overflows.
constexpr std::chrono::milliseconds kMaxWait = std::chrono::hours(24);

std::int64_t to_ns(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration_cast<nanoseconds>(time.time_since_epoch()).count();
}

}  // namespace

FrameClock::FrameClock(double fps, const std::vector<nanoseconds>& offsets) {
  if (!(fps >= 0 && fps <= 1000)) {
    std::ostringstream message;
    message << "frame rate " << fps << " Hz (allowed 0…1000)";
    throw std::invalid_argument(message.str());
  }
  // A rate below one frame a day becomes one a day, again so that no sum of times overflows.
  if (fps > 0) period_ = nanoseconds(std::llround(1e9 / std::max(fps, 1.0 / 86400)));
  for (const nanoseconds offset : offsets) {
    Camera camera;
    camera.offset = offset;
    cameras_.push_back(camera);
    max_offset_ = std::max(max_offset_, offset);
  }
}

std::optional<FrameTick> FrameClock::wait(int camera, std::chrono::milliseconds timeout) noexcept {
  std::unique_lock lock(mutex_);
  const Time now = std::chrono::steady_clock::now();
  const Time deadline = now + std::min(timeout, kMaxWait);
  if (!origin_) origin_ = now;
  Camera& state = cameras_[static_cast<std::size_t>(camera)];
  return period_.count() > 0 ? wait_paced(state, deadline, lock) : wait_free(state, deadline, lock);
}

std::optional<FrameTick> FrameClock::wait_paced(Camera& camera, Time deadline,
                                                std::unique_lock<std::mutex>& lock) noexcept {
  const Time origin = *origin_ + camera.offset;
  const auto newest_due = [&] {
    const std::int64_t periods = (std::chrono::steady_clock::now() - origin) / period_;  // rounds toward 0
    return std::max(camera.next, periods);
  };
  const auto captured = [&](std::int64_t number) { return origin + number * period_; };

  const Time wanted = captured(newest_due());
  changed_.wait_until(lock, std::min(wanted, deadline), [&] { return camera.stopped; });
  if (camera.stopped || std::chrono::steady_clock::now() < wanted) return std::nullopt;
  const std::int64_t number = newest_due();  // the thread may have woken up late
  camera.next = number + 1;
  ++camera.on_loan;
  return FrameTick{number, to_ns(captured(number))};
}

std::optional<FrameTick> FrameClock::wait_free(Camera& camera, Time deadline,
                                               std::unique_lock<std::mutex>& lock) noexcept {
  changed_.wait_until(lock, deadline, [&] { return camera.stopped || may_take_next(camera); });
  if (camera.stopped || !may_take_next(camera)) return std::nullopt;
  const std::int64_t number = camera.next++;
  if (number > newest_) {
    newest_ = number;
    // So that no camera's capture time lies in the future.
    free_captures_[number % 2] = std::chrono::steady_clock::now() - max_offset_;
  }
  ++camera.on_loan;
  changed_.notify_all();
  return FrameTick{number, to_ns(free_captures_[number % 2] + camera.offset)};
}

bool FrameClock::may_take_next(const Camera& camera) const noexcept {
  return camera.on_loan == 0 && std::all_of(cameras_.begin(), cameras_.end(), [&](const Camera& other) {
           return other.stopped || other.next >= camera.next;
         });
}

void FrameClock::give_back(int camera) noexcept {
  {
    const std::lock_guard lock(mutex_);
    --cameras_[static_cast<std::size_t>(camera)].on_loan;
  }
  changed_.notify_all();
}

void FrameClock::stop(int camera) noexcept {
  {
    const std::lock_guard lock(mutex_);
    cameras_[static_cast<std::size_t>(camera)].stopped = true;
  }
  changed_.notify_all();
}

}  // namespace stereod
