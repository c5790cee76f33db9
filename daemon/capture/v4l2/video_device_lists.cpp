// SPDX-License-Identifier: BSD-3-Clause
// What a driver lists: formats, sizes, rates, controls.
#include "daemon/capture/v4l2/video_device.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <functional>

#include "daemon/capture/v4l2/videodev2_fields.h"

namespace stereod::v4l2 {
namespace {

constexpr std::uint32_t kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;
// A driver ends its list with an error. The limit is for a driver that never does.
constexpr std::uint32_t kMaxList = 256;

/// Converts "Exposure Time, Absolute" to the name of v4l2-ctl and of the configuration:
/// exposure_time_absolute.
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

int VideoDevice::offers_size(std::uint32_t fourcc, Size size, bool& offered) {
  const auto width = static_cast<std::uint32_t>(size.width), height = static_cast<std::uint32_t>(size.height);
  offered = false;
  for (std::uint32_t i = 0; i < kMaxList; ++i) {
    v4l2_frmsizeenum answer{};
    answer.index = i;
    answer.pixel_format = fourcc;
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

std::vector<Size> VideoDevice::sizes(std::uint32_t fourcc) {
  std::vector<Size> sizes;
  const auto add = [&](std::uint32_t width, std::uint32_t height) {
    sizes.push_back({static_cast<int>(width), static_cast<int>(height)});
  };
  for (std::uint32_t i = 0; i < kMaxList; ++i) {
    v4l2_frmsizeenum answer{};
    answer.index = i;
    answer.pixel_format = fourcc;
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

OfferedRates VideoDevice::rates(std::uint32_t fourcc, Size size) {
  OfferedRates rates;
  for (std::uint32_t i = 0; i < kMaxList; ++i) {
    v4l2_frmivalenum answer{};
    answer.index = i;
    answer.pixel_format = fourcc;
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
    control.minimum = answer.minimum;
    control.maximum = answer.maximum;
    control.step = std::max(answer.step, 1);
    control.default_value = answer.default_value;
    control.writable = (answer.flags & V4L2_CTRL_FLAG_READ_ONLY) == 0;
    controls.push_back(std::move(control));
  }
  return controls;
}

}  // namespace stereod::v4l2
