#include "daemon/pipeline/pairing_desk.h"

#include <utility>

namespace stereod {

void PairingDesk::add(Side side, FrameLease frame) noexcept {
  const std::int64_t captured_ns = frame.frame().captured_ns;
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  pairing_.add(side, std::move(frame), captured_ns);
  if (pairing_.has_pair()) changed_.notify_one();
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

std::optional<LeasedPair> PairingDesk::wait_pair() noexcept {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return closed_ || pairing_.has_pair(); });
  return pairing_.take();
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
