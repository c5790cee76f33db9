// SPDX-License-Identifier: BSD-3-Clause
// Devices, time and frames. Requests: fake_video_requests.cpp.
#include "tests/support/fake_video.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <thread>

namespace stereod::v4l2 {

class FakeVideo::FakeWaiter final : public Waiter {
 public:
  explicit FakeWaiter(FakeVideo& video) : seen(video.device_changes_), video_(video) {}
  WaitResult wait(int descriptor, std::chrono::milliseconds timeout) noexcept override {
    return video_.wait(descriptor, timeout.count() * 1'000'000, *this);
  }
  void wake() noexcept override { woken = true; }

  std::uint64_t seen;
  std::atomic<bool> woken{false};

 private:
  FakeVideo& video_;
};

FakeCamera& FakeVideo::add(FakeCamera camera) {
  cameras_.push_back(std::make_unique<FakeCamera>(std::move(camera)));
  return *cameras_.back();
}

void FakeVideo::at(std::int64_t time_ns, std::function<void()> action) {
  actions_.emplace(time_ns, std::move(action));
}

void FakeVideo::plug(FakeCamera& camera, bool plugged) {
  const std::lock_guard lock(mutex_);
  camera.plugged = plugged;
  for (auto& [descriptor, opened] : open_) {
    if (opened.camera == &camera && !plugged) opened.unplugged = true;
  }
  ++device_changes_;
}

std::vector<VideoNode> FakeVideo::nodes() {
  const std::lock_guard lock(mutex_);
  std::vector<VideoNode> nodes;
  for (const auto& camera : cameras_) {
    if (camera->plugged) nodes.push_back({camera->node, camera->links, camera->serial});
  }
  // Sorted by port, as VideoSystem requires.
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const VideoNode& a, const VideoNode& b) { return a.links < b.links; });
  return nodes;
}

std::string FakeVideo::resolve(const std::string& name) {
  const std::lock_guard lock(mutex_);
  for (const auto& camera : cameras_) {
    if (!camera->plugged) continue;
    const bool link = std::find(camera->links.begin(), camera->links.end(), name) != camera->links.end();
    if (link || camera->node == name) return camera->node;
  }
  return {};
}

std::string FakeVideo::camera_id(const std::string& node) {
  const std::lock_guard lock(mutex_);
  for (const auto& camera : cameras_) {
    if (camera->plugged && camera->node == node && !camera->function.empty()) return camera->function;
  }
  return node;
}

std::unique_ptr<Waiter> FakeVideo::make_waiter() { return std::make_unique<FakeWaiter>(*this); }

std::int64_t FakeVideo::now_ns() noexcept {
  const std::lock_guard lock(mutex_);
  if (real_time_) {
    now_ns_ = std::chrono::duration_cast<std::chrono::nanoseconds>(
                  std::chrono::steady_clock::now().time_since_epoch())
                  .count();
  }
  return now_ns_;
}

void FakeVideo::sleep_until(std::int64_t time_ns) noexcept {
  while (real_time_ && now_ns() < time_ns) std::this_thread::sleep_for(std::chrono::microseconds(100));
  const std::lock_guard lock(mutex_);
  run_until(time_ns);
}

int FakeVideo::open(const std::string& node, bool convert) {
  const std::lock_guard lock(mutex_);
  for (const auto& camera : cameras_) {
    if (!camera->plugged || camera->node != node) continue;
    int error = 0;
    if (scripted_error(*camera, kFakeOpen, error)) return -error;
    ++camera->opens;
    Opened& opened = open_[next_descriptor_];
    opened.camera = camera.get();
    opened.convert = convert;
    return next_descriptor_++;
  }
  return -ENOENT;
}

void FakeVideo::close(int descriptor) noexcept {
  const std::lock_guard lock(mutex_);
  open_.erase(descriptor);
}

void* FakeVideo::map(int descriptor, std::size_t length, std::int64_t offset, int& error) noexcept {
  const std::lock_guard lock(mutex_);
  Opened& opened = open_.at(descriptor);
  if (scripted_error(*opened.camera, kFakeMap, error)) return nullptr;
  ++mappings_;
  std::vector<std::uint8_t>& buffer = opened.buffers.at(static_cast<std::size_t>(offset));
  buffer.resize(length);
  return buffer.data();
}

void FakeVideo::unmap(void*, std::size_t) noexcept {
  const std::lock_guard lock(mutex_);
  --mappings_;
}

bool FakeVideo::scripted_error(FakeCamera& camera, unsigned long request, int& error) noexcept {
  const auto fault = camera.faults.find(request);
  if (fault == camera.faults.end()) return false;
  if (fault->second.after > 0) {
    --fault->second.after;
    return false;
  }
  if (fault->second.times <= 0) return false;
  --fault->second.times;
  error = fault->second.error;
  return true;
}

int FakeVideo::ioctl(int descriptor, unsigned long request, void* argument) noexcept {
  const std::lock_guard lock(mutex_);
  const auto found = open_.find(descriptor);
  if (found == open_.end()) return EBADF;
  FakeCamera& camera = *found->second.camera;
  if (!camera.plugged || found->second.unplugged) return ENODEV;
  int error = 0;
  if (scripted_error(camera, request, error)) return error;
  return answer(found->second, request, argument);
}

void FakeVideo::deliver(Opened& opened) {
  FakeCamera& camera = *opened.camera;
  const std::int64_t at = opened.next_ns;
  opened.next_ns += camera.period_ns + camera.period_ns * camera.drift_ppb / 1'000'000'000;
  const std::uint32_t sequence = opened.sequence++;
  opened.stuck = opened.stuck || (camera.frozen && camera.thaws_at_start);
  const bool silent = camera.frozen || opened.stuck || opened.starved;
  if (silent || !camera.plugged || opened.unplugged || opened.queued.empty()) return;
  FakeFrame frame;
  frame.sequence = sequence;
  frame.timestamp_ns = at;
  frame.flags = camera.timestamp_flags;
  const std::uint32_t index = opened.queued.front();
  const auto pixels = static_cast<std::size_t>(opened.format.size.width * opened.format.size.height);
  frame.bytes.assign(pixels * 2, static_cast<std::uint8_t>(sequence));
  if (camera.on_frame) camera.on_frame(frame);
  opened.queued.pop_front();
  std::vector<std::uint8_t>& buffer = opened.buffers[index];
  std::copy_n(frame.bytes.begin(), std::min(frame.bytes.size(), buffer.size()), buffer.begin());
  opened.filled.push_back({index, std::move(frame)});
}

// Runs all events up to @p time_ns, in the order of time.
void FakeVideo::run_until(std::int64_t time_ns) {
  while (true) {
    const std::int64_t next = next_event(time_ns + 1);
    if (next > time_ns) break;
    if (!real_time_) now_ns_ = std::max(now_ns_, next);
    if (!actions_.empty() && actions_.begin()->first <= next) {
      const auto action = std::move(actions_.begin()->second);
      actions_.erase(actions_.begin());
      action();
      continue;
    }
    for (auto& [descriptor, opened] : open_) {
      if (opened.streaming && opened.next_ns <= next) deliver(opened);
    }
  }
  if (!real_time_) now_ns_ = std::max(now_ns_, time_ns);
}

std::int64_t FakeVideo::next_event(std::int64_t limit_ns) const {
  std::int64_t next = limit_ns;
  if (!actions_.empty()) next = std::min(next, actions_.begin()->first);
  for (const auto& [descriptor, opened] : open_) {
    if (opened.streaming) next = std::min(next, opened.next_ns);
  }
  return next;
}

bool FakeVideo::ready(int descriptor, WaitResult& result) {
  const auto found = open_.find(descriptor);
  if (found == open_.end()) return false;
  int error = 0;
  result.readable = !found->second.filled.empty();
  const Opened& opened = found->second;
  const bool unplugged = !opened.camera->plugged || opened.unplugged;
  result.broken = unplugged || opened.no_buffer_yet || scripted_error(*opened.camera, kFakePoll, error);
  return result.readable || result.broken;
}

WaitResult FakeVideo::wait(int descriptor, std::int64_t timeout_ns, FakeWaiter& waiter) {
  const std::int64_t until_ns = now_ns() + timeout_ns;
  WaitResult result;
  while (true) {
    {
      const std::lock_guard lock(mutex_);
      ++waits_;
      const std::int64_t now = now_ns();
      run_until(now);
      if (waiter.woken) return result;
      if (descriptor >= 0 && ready(descriptor, result)) return result;
      if (descriptor < 0 && std::exchange(waiter.seen, device_changes_) != device_changes_) {
        result.devices_changed = true;
        return result;
      }
      if (now >= until_ns) return result;
      if (!real_time_) run_until(next_event(until_ns));
    }
    if (real_time_) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

}  // namespace stereod::v4l2
