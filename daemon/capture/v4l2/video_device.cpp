#include "daemon/capture/v4l2/video_device.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace stereod {
namespace {

constexpr std::uint32_t kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;
// Drivers end their lists with an error; one that never does is cut off here.
constexpr std::uint32_t kMaxList = 256;

std::string text_of(const __u8* field, std::size_t size) {
  const char* text = reinterpret_cast<const char*>(field);
  std::string name(text, strnlen(text, size));
  // It goes to terminals and logs, and comes from whatever was plugged in.
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  std::replace_if(name.begin(), name.end(), is_control, '?');
  return name;
}

v4l2_buffer buffer_of(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = kCapture;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

double rate_of(const v4l2_fract& interval) {
  return interval.numerator > 0 ? static_cast<double>(interval.denominator) / interval.numerator : 0;
}

/// "Exposure Time, Absolute" as v4l2-ctl and the configuration write it: exposure_time_absolute.
std::string control_name(const std::string& title) {
  std::string name;
  for (const char c : title) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (letter) {
      name += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

}  // namespace

std::string fourcc_name(std::uint32_t format) {
  std::string name;
  for (int shift = 0; shift < 32; shift += 8) {
    const auto c = static_cast<unsigned char>(format >> shift);
    name += c > ' ' && c < 127 ? static_cast<char>(c) : c == ' ' ? ' ' : '?';
  }
  while (!name.empty() && name.back() == ' ') name.pop_back();
  return name;
}

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

int VideoDevice::formats(std::vector<std::uint32_t>& formats) {
  formats.clear();
  for (std::uint32_t i = 0; i < kMaxList; ++i) {
    v4l2_fmtdesc answer{};
    answer.index = i;
    answer.type = kCapture;
    if (const int error = request(VIDIOC_ENUM_FMT, &answer)) {
      return error == EINVAL || error == ENOTTY ? 0 : error;
    }
    formats.push_back(answer.pixelformat);
  }
  return 0;
}

int VideoDevice::offers_size(std::uint32_t pixels, Size size, bool& offered) {
  const auto width = static_cast<std::uint32_t>(size.width), height = static_cast<std::uint32_t>(size.height);
  offered = false;
  for (std::uint32_t i = 0; i < kMaxList; ++i) {
    v4l2_frmsizeenum answer{};
    answer.index = i;
    answer.pixel_format = pixels;
    if (const int error = request(VIDIOC_ENUM_FRAMESIZES, &answer)) {
      if (i == 0 && (error == EINVAL || error == ENOTTY)) offered = true;
      return error == EINVAL || error == ENOTTY ? 0 : error;
    }
    if (answer.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      offered = answer.discrete.width == width && answer.discrete.height == height;
    } else {
      const v4l2_frmsize_stepwise& range = answer.stepwise;
      offered = width >= range.min_width && width <= range.max_width && height >= range.min_height &&
                height <= range.max_height;
      return 0;
    }
    if (offered) return 0;
  }
  return 0;
}

std::vector<Size> VideoDevice::sizes(std::uint32_t pixels) {
  std::vector<Size> sizes;
  const auto add = [&](std::uint32_t width, std::uint32_t height) {
    sizes.push_back({static_cast<int>(width), static_cast<int>(height)});
  };
  for (std::uint32_t i = 0; i < kMaxList; ++i) {
    v4l2_frmsizeenum answer{};
    answer.index = i;
    answer.pixel_format = pixels;
    if (request(VIDIOC_ENUM_FRAMESIZES, &answer) != 0) break;
    if (answer.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      add(answer.discrete.width, answer.discrete.height);
    } else {
      add(answer.stepwise.min_width, answer.stepwise.min_height);
      add(answer.stepwise.max_width, answer.stepwise.max_height);
      break;
    }
  }
  return sizes;
}

OfferedRates VideoDevice::rates(std::uint32_t pixels, Size size) {
  OfferedRates rates;
  for (std::uint32_t i = 0; i < kMaxList; ++i) {
    v4l2_frmivalenum answer{};
    answer.index = i;
    answer.pixel_format = pixels;
    answer.width = static_cast<std::uint32_t>(size.width);
    answer.height = static_cast<std::uint32_t>(size.height);
    if (request(VIDIOC_ENUM_FRAMEINTERVALS, &answer) != 0) break;
    if (answer.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      rates.listed.push_back(rate_of(answer.discrete));
    } else {
      rates.listed = {rate_of(answer.stepwise.min), rate_of(answer.stepwise.max)};
      rates.range = true;
      break;
    }
  }
  std::sort(rates.listed.begin(), rates.listed.end(), std::greater<>());
  return rates;
}

int VideoDevice::set_format(DeviceFormat& format) {
  v4l2_format answer{};
  answer.type = kCapture;
  answer.fmt.pix.width = static_cast<std::uint32_t>(format.size.width);
  answer.fmt.pix.height = static_cast<std::uint32_t>(format.size.height);
  answer.fmt.pix.pixelformat = format.pixels;
  answer.fmt.pix.field = V4L2_FIELD_ANY;
  if (const int error = request(VIDIOC_S_FMT, &answer)) return error;
  const v4l2_pix_format& got = answer.fmt.pix;
  constexpr std::uint32_t kMax = 1u << 20;  // px; keeps what follows from overflowing
  format.pixels = got.pixelformat;
  format.size = {static_cast<int>(std::min(got.width, kMax)), static_cast<int>(std::min(got.height, kMax))};
  format.bytes_per_line = got.bytesperline;
  format.image_bytes = got.sizeimage;
  return 0;
}

int VideoDevice::set_rate(double fps, double& got) {
  got = 0;
  v4l2_streamparm answer{};
  answer.type = kCapture;
  answer.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(fps * 1000 + 0.5)};
  if (const int error = request(VIDIOC_S_PARM, &answer)) {
    return error == EINVAL || error == ENOTTY ? 0 : error;  // many drivers have no rate to set
  }
  got = rate_of(answer.parm.capture.timeperframe);
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

std::vector<DeviceControl> VideoDevice::controls() {
  std::vector<DeviceControl> controls;
  std::uint32_t id = 0;
  for (std::uint32_t i = 0; i < kMaxList; ++i) {
    v4l2_queryctrl answer{};
    answer.id = id | V4L2_CTRL_FLAG_NEXT_CTRL;
    if (request(VIDIOC_QUERYCTRL, &answer) != 0) break;
    id = answer.id;
    const bool number = answer.type == V4L2_CTRL_TYPE_INTEGER || answer.type == V4L2_CTRL_TYPE_BOOLEAN ||
                        answer.type == V4L2_CTRL_TYPE_MENU || answer.type == V4L2_CTRL_TYPE_INTEGER_MENU;
    if (!number || (answer.flags & V4L2_CTRL_FLAG_DISABLED) != 0) continue;
    DeviceControl control;
    control.id = answer.id;
    control.name = control_name(text_of(answer.name, sizeof answer.name));
    control.least = answer.minimum;
    control.most = answer.maximum;
    control.step = std::max(answer.step, 1);
    control.preset = answer.default_value;
    control.writable = (answer.flags & V4L2_CTRL_FLAG_READ_ONLY) == 0;
    controls.push_back(std::move(control));
  }
  return controls;
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

}  // namespace stereod
