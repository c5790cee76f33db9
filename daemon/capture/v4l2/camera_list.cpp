// SPDX-License-Identifier: BSD-3-Clause
// What stereod --list-cameras prints.
#include "daemon/capture/v4l2/camera_list.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "core/base/text.h"
#include "daemon/capture/v4l2/pixel_format.h"
#include "daemon/capture/v4l2/video_device.h"

namespace stereod::v4l2 {
namespace {

std::string row(const std::string& label, const std::string& text) {
  std::string line = "  " + label;
  line.resize(std::max<std::size_t>(line.size(), 12), ' ');
  return line + "  " + text + "\n";
}

std::string sizes_of(VideoDevice& device, std::uint32_t fourcc) {
  std::string text;
  for (const Size size : device.sizes(fourcc)) {
    if (!text.empty()) text += ", ";
    text += to_string(size);
    std::string rates;
    for (const double fps : device.rates(fourcc, size).listed)
      rates += (rates.empty() ? " at " : " ") + significant(fps, 4);
    text += rates;
  }
  return text.empty() ? "any size" : text;
}

std::string formats_of(VideoDevice& device) {
  std::vector<std::uint32_t> formats;
  device.formats(formats);
  std::string text;
  for (const std::uint32_t fourcc : formats) {
    const PixelFormat* format = find_pixel_format(fourcc);
    const std::string name = format != nullptr ? std::string(format->name) : fourcc_name(fourcc) + " (auto)";
    text += row(name, sizes_of(device, fourcc));
  }
  return text;
}

std::string controls_of(VideoDevice& device) {
  std::string text;
  for (const DeviceControl& control : device.controls()) {
    std::int32_t value = 0;
    const std::string now = device.get_control(control.id, value) == 0 ? std::to_string(value) : "?";
    std::string name = control.name;
    name.resize(std::max<std::size_t>(name.size(), 30), ' ');
    text += row("", fmt::format("{}  {}  (range {}…{}, default {})", name, now, control.minimum,
                                control.maximum, control.default_value));
  }
  return text.empty() ? "" : row("controls", "present value, range and default") + text;
}

}  // namespace

std::string list_cameras(VideoSystem& system) {
  std::string text;
  int cameras = 0;
  for (const VideoNode& node : system.nodes()) {
    VideoDevice device(system);
    DeviceCapability capability;
    if (const int error = device.open(node.node, false)) {
      text += node.node + " cannot be opened: " + std::strerror(error) + "\n\n";
      continue;
    }
    if (device.capability(capability) != 0 || !capability.captures || !capability.streams) continue;
    ++cameras;
    text += capability.card + "\n";
    for (const std::string& link : node.links) text += row("device", link);
    if (!node.serial.empty()) text += row("device", "serial:" + node.serial);
    text += row("device", node.node + (node.links.empty() ? "" : " (may change)"));
    text += row("bus", capability.bus) + formats_of(device) + controls_of(device) + "\n";
  }
  if (cameras == 0) text += "There is no camera: none is plugged in, or this user may not see it.\n";
  return text;
}

}  // namespace stereod::v4l2
