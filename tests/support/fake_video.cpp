#include "tests/support/fake_video.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <thread>

namespace stereod {

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
    if (opened.camera == &camera && !plugged) opened.gone = true;
  }
  ++device_changes_;
}

std::vector<VideoNode> FakeVideo::nodes() {
  const std::lock_guard lock(mutex_);
  std::vector<VideoNode> nodes;
  for (const auto& camera : cameras_) {
    if (camera->plugged) nodes.push_back({camera->node, camera->links, camera->serial});
  }
  // As the kernel's are, by port.
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

std::string FakeVideo::camera_of(const std::string& node) {
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
  if (!camera.plugged || found->second.gone) return ENODEV;
  int error = 0;
  if (scripted_error(camera, request, error)) return error;
  return answer(found->second, request, argument);
}

int FakeVideo::answer(Opened& opened, unsigned long request, void* argument) {
  FakeCamera& camera = *opened.camera;
  switch (request) {
    case VIDIOC_QUERYCAP: {
      auto& out = *static_cast<v4l2_capability*>(argument);
      std::strncpy(reinterpret_cast<char*>(out.card), camera.card.c_str(), sizeof out.card - 1);
      std::strncpy(reinterpret_cast<char*>(out.bus_info), camera.bus.c_str(), sizeof out.bus_info - 1);
      out.capabilities = V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_META_CAPTURE;
      out.device_caps =
          V4L2_CAP_STREAMING | (camera.capture ? V4L2_CAP_VIDEO_CAPTURE : V4L2_CAP_META_CAPTURE);
      return 0;
    }
    case VIDIOC_S_FMT: {
      auto& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
      DeviceFormat format{pix.pixelformat, {static_cast<int>(pix.width), static_cast<int>(pix.height)}, 0, 0};
      if (camera.on_set_format) camera.on_set_format(format);
      pix.pixelformat = format.pixels;
      pix.width = static_cast<std::uint32_t>(format.size.width);
      pix.height = static_cast<std::uint32_t>(format.size.height);
      pix.bytesperline = format.bytes_per_line;
      pix.sizeimage = format.image_bytes > 0 ? format.image_bytes : pix.width * pix.height * 2 + 4096;
      opened.format = format;
      opened.format.image_bytes = pix.sizeimage;
      return 0;
    }
    case VIDIOC_S_PARM: {
      auto& interval = static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe;
      const double fps = static_cast<double>(interval.denominator) / interval.numerator;
      double best = 0;
      for (const FakeMode& mode : camera.modes) {
        if (mode.pixels != opened.format.pixels || mode.size != opened.format.size) continue;
        for (const double rate : mode.rates) {
          if (best == 0 || std::abs(rate - fps) < std::abs(best - fps)) best = rate;
        }
      }
      if (best == 0) return EINVAL;
      camera.period_ns = static_cast<std::int64_t>(1e9 / best);
      interval = {1000, static_cast<std::uint32_t>(best * 1000)};
      return 0;
    }
    case VIDIOC_ENUM_FMT:
    case VIDIOC_ENUM_FRAMESIZES:
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return answer_listing(opened, request, argument);
    case VIDIOC_QUERYCTRL:
    case VIDIOC_G_CTRL:
    case VIDIOC_S_CTRL:
      return answer_controls(opened, request, argument);
    default:
      return answer_buffers(opened, request, argument);
  }
}

int FakeVideo::answer_listing(Opened& opened, unsigned long request, void* argument) {
  const std::vector<FakeMode>& modes = opened.camera->modes;
  if (request == VIDIOC_ENUM_FMT) {
    auto& out = *static_cast<v4l2_fmtdesc*>(argument);
    std::vector<std::uint32_t> formats;
    for (const FakeMode& mode : modes) {
      if (std::find(formats.begin(), formats.end(), mode.pixels) == formats.end())
        formats.push_back(mode.pixels);
    }
    if (out.index >= formats.size()) return EINVAL;
    out.pixelformat = formats[out.index];
    return 0;
  }
  if (request == VIDIOC_ENUM_FRAMESIZES) {
    auto& out = *static_cast<v4l2_frmsizeenum*>(argument);
    std::uint32_t place = 0;
    for (const FakeMode& mode : modes) {
      if (mode.pixels != out.pixel_format || place++ != out.index) continue;
      out.type = V4L2_FRMSIZE_TYPE_DISCRETE;
      out.discrete = {static_cast<std::uint32_t>(mode.size.width),
                      static_cast<std::uint32_t>(mode.size.height)};
      return 0;
    }
    return EINVAL;
  }
  auto& out = *static_cast<v4l2_frmivalenum*>(argument);
  for (const FakeMode& mode : modes) {
    const Size size{static_cast<int>(out.width), static_cast<int>(out.height)};
    if (mode.pixels != out.pixel_format || mode.size != size || out.index >= mode.rates.size()) continue;
    out.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    out.discrete = {1000, static_cast<std::uint32_t>(mode.rates[out.index] * 1000)};
    return 0;
  }
  return EINVAL;
}

int FakeVideo::answer_buffers(Opened& opened, unsigned long request, void* argument) {
  auto& buffer = *static_cast<v4l2_buffer*>(argument);
  switch (request) {
    case VIDIOC_REQBUFS:
      opened.buffers.resize(static_cast<v4l2_requestbuffers*>(argument)->count);
      return 0;
    case VIDIOC_QUERYBUF:
      if (buffer.index >= opened.buffers.size()) return EINVAL;
      buffer.length = opened.format.image_bytes;
      buffer.m.offset = buffer.index;
      return 0;
    case VIDIOC_QBUF:
      if (buffer.index >= opened.buffers.size()) return EINVAL;
      if (std::find(opened.queued.begin(), opened.queued.end(), buffer.index) != opened.queued.end())
        return EINVAL;
      opened.queued.push_back(buffer.index);
      opened.no_buffer_yet = false;
      return 0;
    case VIDIOC_DQBUF: {
      run_until(now_ns());
      if (opened.filled.empty()) return EAGAIN;
      const Opened::Filled filled = std::move(opened.filled.front());
      opened.filled.pop_front();
      buffer.index = filled.index;
      buffer.bytesused =
          filled.frame.bytesused.value_or(static_cast<std::uint32_t>(filled.frame.bytes.size()));
      buffer.sequence = filled.frame.sequence;
      buffer.flags = filled.frame.flags;
      buffer.timestamp.tv_sec = static_cast<time_t>(filled.frame.timestamp_ns / 1'000'000'000);
      buffer.timestamp.tv_usec = static_cast<suseconds_t>(filled.frame.timestamp_ns % 1'000'000'000 / 1000);
      return 0;
    }
    case VIDIOC_STREAMON:
      return stream_on(opened);
    case VIDIOC_STREAMOFF:
      opened.streaming = false;
      opened.no_buffer_yet = true;
      opened.queued.clear();
      opened.filled.clear();
      return 0;
    default:
      return ENOTTY;
  }
}

int FakeVideo::answer_controls(Opened& opened, unsigned long request, void* argument) {
  std::vector<FakeControl>& controls = opened.camera->controls;
  if (request == VIDIOC_QUERYCTRL) {
    auto& out = *static_cast<v4l2_queryctrl*>(argument);
    const std::uint32_t after = out.id & ~V4L2_CTRL_FLAG_NEXT_CTRL;
    const FakeControl* next = nullptr;
    for (const FakeControl& control : controls) {
      if (control.id > after && (next == nullptr || control.id < next->id)) next = &control;
    }
    if (next == nullptr) return EINVAL;
    out.id = next->id;
    out.type = next->type;
    std::strncpy(reinterpret_cast<char*>(out.name), next->title.c_str(), sizeof out.name - 1);
    out.minimum = next->least;
    out.maximum = next->most;
    out.step = 1;
    out.default_value = next->preset;
    out.flags = next->flags;
    return 0;
  }
  auto& value = *static_cast<v4l2_control*>(argument);
  for (FakeControl& control : controls) {
    if (control.id != value.id) continue;
    if (request == VIDIOC_G_CTRL) {
      value.value = control.value;
      return 0;
    }
    control.value = std::clamp(value.value, control.least, control.most);
    opened.camera->log.push_back(control.title + "=" + std::to_string(value.value));
    if (opened.camera->on_set_control) opened.camera->on_set_control(control);
    return 0;
  }
  return EINVAL;
}

double FakeVideo::traffic() const {
  double bytes = 0;
  for (const auto& [descriptor, opened] : open_) {
    if (!opened.streaming) continue;
    const double per_pixel = opened.format.pixels == fourcc('M', 'J', 'P', 'G') ? 0.2 : 2;
    bytes += per_pixel * opened.format.size.width * opened.format.size.height * 1e9 /
             static_cast<double>(opened.camera->period_ns);
  }
  return bytes;
}

int FakeVideo::stream_on(Opened& opened) {
  FakeCamera& camera = *opened.camera;
  opened.streaming = true;
  opened.starved = bus_capacity > 0 && traffic() > bus_capacity;
  if (opened.starved && !starve) {
    opened.streaming = false;
    return ENOSPC;
  }
  ++camera.starts;
  opened.sequence = 0;
  opened.stuck = camera.frozen && camera.thaws_at_start;
  const std::int64_t now = now_ns();
  if (camera.keeps_phase) {
    const std::int64_t periods = (now + 1'000'000 - camera.phase_ns) / camera.period_ns + 1;
    opened.next_ns = camera.phase_ns + periods * camera.period_ns;
  } else {
    opened.next_ns = now + camera.start_latency_ns;
  }
  return 0;
}

void FakeVideo::deliver(Opened& opened) {
  FakeCamera& camera = *opened.camera;
  const std::int64_t at = opened.next_ns;
  opened.next_ns += camera.period_ns + camera.period_ns * camera.drift_ppb / 1'000'000'000;
  const std::uint32_t sequence = opened.sequence++;
  opened.stuck = opened.stuck || (camera.frozen && camera.thaws_at_start);
  const bool silent = camera.frozen || opened.stuck || opened.starved;
  if (silent || !camera.plugged || opened.gone || opened.queued.empty()) return;
  FakeFrame frame;
  frame.sequence = sequence;
  frame.timestamp_ns = at;
  frame.flags = camera.stamp_flags;
  const std::uint32_t index = opened.queued.front();
  const auto pixels = static_cast<std::size_t>(opened.format.size.width * opened.format.size.height);
  frame.bytes.assign(pixels * 2, static_cast<std::uint8_t>(sequence));
  if (camera.on_frame) camera.on_frame(frame);
  opened.queued.pop_front();
  std::vector<std::uint8_t>& buffer = opened.buffers[index];
  std::copy_n(frame.bytes.begin(), std::min(frame.bytes.size(), buffer.size()), buffer.begin());
  opened.filled.push_back({index, std::move(frame)});
}

// Lets everything happen that is due by then, in the order of time.
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
  const bool gone = !opened.camera->plugged || opened.gone;
  result.broken = gone || opened.no_buffer_yet || scripted_error(*opened.camera, kFakePoll, error);
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

}  // namespace stereod
