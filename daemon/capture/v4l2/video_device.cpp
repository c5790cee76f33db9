// SPDX-License-Identifier: BSD-3-Clause
// Opening, formats, buffers, streaming, control values. Listings: video_device_lists.cpp.
#include "daemon/capture/v4l2/video_device.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "daemon/capture/v4l2/videodev2_fields.h"

namespace stereod::v4l2 {
namespace {

constexpr std::uint32_t kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;

v4l2_buffer buffer_of(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = kCapture;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

}  // namespace

int VideoDevice::open(const std::string& node, bool convert) {
  close();
  const int result = system_->open(node, convert);
  if (result < 0) return -result;
  descriptor_ = result;
  return 0;
}

void VideoDevice::close() noexcept {
  if (descriptor_ >= 0) system_->close(descriptor_);
  descriptor_ = -1;
}

int VideoDevice::capability(DeviceCapability& capability) {
  v4l2_capability answer{};
  if (const int error = request(VIDIOC_QUERYCAP, &answer)) return error;
  const bool own = (answer.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const std::uint32_t flags = own ? answer.device_caps : answer.capabilities;
  capability.card = text_of(answer.card, sizeof answer.card);
  capability.bus = text_of(answer.bus_info, sizeof answer.bus_info);
  capability.captures = (flags & V4L2_CAP_VIDEO_CAPTURE) != 0;
  capability.streams = (flags & V4L2_CAP_STREAMING) != 0;
  return 0;
}

int VideoDevice::set_format(DeviceFormat& format) {
  v4l2_format answer{};
  answer.type = kCapture;
  answer.fmt.pix.width = static_cast<std::uint32_t>(format.size.width);
  answer.fmt.pix.height = static_cast<std::uint32_t>(format.size.height);
  answer.fmt.pix.pixelformat = format.fourcc;
  answer.fmt.pix.field = V4L2_FIELD_ANY;
  if (const int error = request(VIDIOC_S_FMT, &answer)) return error;
  const v4l2_pix_format& got = answer.fmt.pix;
  constexpr std::uint32_t kMax = 1u << 20;  // [px] keeps products of sizes from overflowing
  format.fourcc = got.pixelformat;
  format.size = {static_cast<int>(std::min(got.width, kMax)), static_cast<int>(std::min(got.height, kMax))};
  format.bytes_per_line = got.bytesperline;
  format.image_bytes = got.sizeimage;
  return 0;
}

int VideoDevice::set_rate(double fps, double& actual) {
  actual = 0;
  v4l2_streamparm answer{};
  answer.type = kCapture;
  answer.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(std::lround(fps * 1000))};
  if (const int error = request(VIDIOC_S_PARM, &answer)) {
    return error == EINVAL || error == ENOTTY ? 0 : error;  // many drivers have a fixed rate
  }
  actual = rate_of(answer.parm.capture.timeperframe);
  return 0;
}

int VideoDevice::request_buffers(std::uint32_t& count) noexcept {
  v4l2_requestbuffers answer{};
  answer.count = count;
  answer.type = kCapture;
  answer.memory = V4L2_MEMORY_MMAP;
  if (const int error = request(VIDIOC_REQBUFS, &answer)) return error;
  count = answer.count;
  return 0;
}

int VideoDevice::map_buffer(std::uint32_t index, std::span<const std::uint8_t>& memory) noexcept {
  v4l2_buffer buffer = buffer_of(index);
  if (const int error = request(VIDIOC_QUERYBUF, &buffer)) return error;
  int error = 0;
  const void* mapped = system_->map(descriptor_, buffer.length, buffer.m.offset, error);
  if (mapped == nullptr) return error;
  memory = {static_cast<const std::uint8_t*>(mapped), buffer.length};
  return 0;
}

void VideoDevice::unmap_buffer(std::span<const std::uint8_t> memory) noexcept {
  system_->unmap(const_cast<std::uint8_t*>(memory.data()), memory.size());
}

int VideoDevice::queue(std::uint32_t index) noexcept {
  v4l2_buffer buffer = buffer_of(index);
  return request(VIDIOC_QBUF, &buffer);
}

int VideoDevice::dequeue(FilledBuffer& filled) noexcept {
  v4l2_buffer buffer = buffer_of(0);
  if (const int error = request(VIDIOC_DQBUF, &buffer)) return error;
  filled.index = buffer.index;
  filled.bytes = buffer.bytesused;
  filled.sequence = buffer.sequence;
  filled.timestamp_ns =
      std::int64_t{buffer.timestamp.tv_sec} * 1'000'000'000 + std::int64_t{buffer.timestamp.tv_usec} * 1000;
  filled.error = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  filled.timestamp_monotonic =
      (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  filled.timestamp_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return 0;
}

int VideoDevice::stream_on() noexcept {
  int type = kCapture;
  return request(VIDIOC_STREAMON, &type);
}

int VideoDevice::stream_off() noexcept {
  int type = kCapture;
  return request(VIDIOC_STREAMOFF, &type);
}

int VideoDevice::get_control(std::uint32_t id, std::int32_t& value) noexcept {
  v4l2_control control{};
  control.id = id;
  if (const int error = request(VIDIOC_G_CTRL, &control)) return error;
  value = control.value;
  return 0;
}

int VideoDevice::set_control(std::uint32_t id, std::int32_t value) noexcept {
  v4l2_control control{};
  control.id = id;
  control.value = value;
  return request(VIDIOC_S_CTRL, &control);
}

}  // namespace stereod::v4l2
