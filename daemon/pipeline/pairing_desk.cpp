#include "daemon/pipeline/pairing_desk.h"

#include <algorithm>
#include <utility>

namespace stereod {
namespace {

int number_of(Side side) noexcept { return side == Side::kLeft ? 0 : 1; }

}  // namespace

void PairingDesk::add(Side side, FrameLease frame) noexcept {
  const std::int64_t captured_ns = frame.frame().captured_ns;
  const LumaView luma = frame.frame().luma;
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  layout_[number_of(side)] = SourceLayout{luma.size, luma.row_stride, luma.pixel_stride};
  pairing_.add(side, std::move(frame), captured_ns);
  if (pairing_.has_pair()) changed_.notify_one();
}

void PairingDesk::set_frame_time(Side side, std::int64_t frame_ns) noexcept {
  const std::lock_guard lock(mutex_);
  frame_ns_[number_of(side)] = frame_ns;
  // The frames of the faster camera are all near one of the slower one.
  const std::int64_t slower_ns = std::max(frame_ns_[0], frame_ns_[1]);
  if (half_frames_ && slower_ns > 0) pairing_.set_tolerance_ns(slower_ns / 2);
}

void PairingDesk::camera_interrupted(Side side) noexcept {
  const std::lock_guard lock(mutex_);
  pairing_.forget_waiting(side);
}

void PairingDesk::camera_finished() noexcept {
  const std::lock_guard lock(mutex_);
  if (++cameras_finished_ < 2) return;
  closed_ = true;
  changed_.notify_all();
}

void PairingDesk::close() noexcept {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

std::optional<LeasedPair> PairingDesk::wait_pair(const std::atomic<bool>& called_off) noexcept {
  std::unique_lock lock(mutex_);
  taker_waits_ = true;
  changed_.wait(lock, [&] { return called_off || closed_ || pairing_.has_pair(); });
  taker_waits_ = false;
  if (called_off) return std::nullopt;
  return pairing_.take();
}

void PairingDesk::wake_taker() noexcept {
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

bool PairingDesk::taker_waits() const noexcept {
  const std::lock_guard lock(mutex_);
  return taker_waits_ && !pairing_.has_pair();
}

std::optional<SourceLayout> PairingDesk::layout(Side side) const noexcept {
  const std::lock_guard lock(mutex_);
  return layout_[number_of(side)];
}

void PairingDesk::clear() noexcept {
  const std::lock_guard lock(mutex_);
  pairing_.clear();
}

PairingCounts PairingDesk::counts() const noexcept {
  const std::lock_guard lock(mutex_);
  return pairing_.counts();
}

}  // namespace stereod
