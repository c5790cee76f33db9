// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/capture/pair_queue.h"

#include <algorithm>
#include <utility>

namespace stereod {
namespace {

int index_of(Side side) noexcept { return side == Side::kLeft ? 0 : 1; }

}  // namespace

void PairQueue::add(Side side, FrameLease frame) noexcept {
  const std::int64_t captured_ns = frame.frame().captured_ns;
  const LumaView luma = frame.frame().luma;
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  layout_[index_of(side)] = SourceLayout{luma.size, luma.row_stride, luma.pixel_stride};
  pairing_.add(side, std::move(frame), captured_ns);
  if (pairing_.has_pair()) changed_.notify_one();
}

void PairQueue::set_frame_time(Side side, std::int64_t frame_ns) noexcept {
  const std::lock_guard lock(mutex_);
  frame_ns_[index_of(side)] = frame_ns;
  // Every frame of the slower camera has a frame of the faster one within half of its own period.
  const std::int64_t longer_ns = std::max(frame_ns_[0], frame_ns_[1]);
  if (half_frame_ && longer_ns > 0) pairing_.set_tolerance_ns(longer_ns / 2);
}

void PairQueue::camera_interrupted(Side side) noexcept {
  const std::lock_guard lock(mutex_);
  pairing_.forget_waiting(side);
}

void PairQueue::camera_finished() noexcept {
  const std::lock_guard lock(mutex_);
  if (++cameras_finished_ < 2) return;
  closed_ = true;
  changed_.notify_all();
}

void PairQueue::close() noexcept {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

std::optional<LeasedPair> PairQueue::wait_pair(const std::atomic<bool>& cancelled) noexcept {
  std::unique_lock lock(mutex_);
  consumer_waits_ = true;
  changed_.wait(lock, [&] { return cancelled || closed_ || pairing_.has_pair(); });
  consumer_waits_ = false;
  if (cancelled) return std::nullopt;
  return pairing_.take();
}

std::optional<LeasedPair> PairQueue::wait_pair_for(std::chrono::milliseconds timeout) noexcept {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [&] { return closed_ || pairing_.has_pair(); });
  return pairing_.take();
}

bool PairQueue::is_finished() const noexcept {
  const std::lock_guard lock(mutex_);
  return closed_ && !pairing_.has_pair();
}

void PairQueue::wake_consumer() noexcept {
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

bool PairQueue::consumer_waits() const noexcept {
  const std::lock_guard lock(mutex_);
  return consumer_waits_ && !pairing_.has_pair();
}

std::optional<SourceLayout> PairQueue::layout(Side side) const noexcept {
  const std::lock_guard lock(mutex_);
  return layout_[index_of(side)];
}

void PairQueue::clear() noexcept {
  const std::lock_guard lock(mutex_);
  pairing_.clear();
}

PairingCounts PairQueue::counts() const noexcept {
  const std::lock_guard lock(mutex_);
  return pairing_.counts();
}

}  // namespace stereod
