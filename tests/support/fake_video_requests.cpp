// SPDX-License-Identifier: BSD-3-Clause
// The scripted answers to V4L2's requests.
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "tests/support/fake_video.h"

namespace stereod::v4l2 {

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
      pix.pixelformat = format.fourcc;
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
        if (mode.fourcc != opened.format.fourcc || mode.size != opened.format.size) continue;
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
      if (std::find(formats.begin(), formats.end(), mode.fourcc) == formats.end())
        formats.push_back(mode.fourcc);
    }
    if (out.index >= formats.size()) return EINVAL;
    out.pixelformat = formats[out.index];
    return 0;
  }
  if (request == VIDIOC_ENUM_FRAMESIZES) {
    auto& out = *static_cast<v4l2_frmsizeenum*>(argument);
    std::uint32_t place = 0;
    for (const FakeMode& mode : modes) {
      if (mode.fourcc != out.pixel_format || place++ != out.index) continue;
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
    if (mode.fourcc != out.pixel_format || mode.size != size || out.index >= mode.rates.size()) continue;
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
    out.minimum = next->minimum;
    out.maximum = next->maximum;
    out.step = 1;
    out.default_value = next->default_value;
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
    control.value = std::clamp(value.value, control.minimum, control.maximum);
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
    const double per_pixel = opened.format.fourcc == make_fourcc('M', 'J', 'P', 'G') ? 0.2 : 2;
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

}  // namespace stereod::v4l2
