#include "daemon/capture/v4l2/camera_list.h"

#include <algorithm>
#include <cstring>

#include "core/base/text.h"
#include "daemon/capture/v4l2/pixel_format.h"
#include "daemon/capture/v4l2/video_device.h"

namespace stereod {
namespace {

std::string row(const std::string& label, const std::string& text) {
  std::string line = "  " + label;
  line.resize(std::max<std::size_t>(line.size(), 12), ' ');
  return line + "  " + text + "\n";
}

std::string sizes_of(VideoDevice& device, std::uint32_t pixels) {
  std::string text;
  for (const Size size : device.sizes(pixels)) {
    if (!text.empty()) text += ", ";
    text += to_string(size);
    std::string rates;
    for (const double fps : device.rates(pixels, size).listed)
      rates += (rates.empty() ? " at " : " ") + significant(fps, 4);
    text += rates;
  }
  return text.empty() ? "any size" : text;
}

std::string formats_of(VideoDevice& device) {
  std::vector<std::uint32_t> formats;
  device.formats(formats);
  std::string text;
  for (const std::uint32_t pixels : formats) {
    const PixelFormat* format = find_pixel_format(pixels);
    const std::string name = format != nullptr ? std::string(format->name) : fourcc_name(pixels) + " (auto)";
    text += row(name, sizes_of(device, pixels));
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
    text += row("", name + "  " + now + "  (" + std::to_string(control.least) + " to " +
                        std::to_string(control.most) + ", by itself " + std::to_string(control.preset) + ")");
  }
  return text.empty() ? "" : row("controls", "what it is now, and what is allowed") + text;
}

}  // namespace

std::string list_cameras(VideoSystem& system) {
  std::string text;
  int cameras = 0;
  for (const VideoNode& node : system.nodes()) {
    VideoDevice device(system);
    DeviceCapability capability;
    if (const int error = device.open(node.node, false)) {
      text +=
          node.node + " cannot be opened: " + std::strerror(error) + "\n\n";  // NOLINT(concurrency-mt-unsafe)
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

}  // namespace stereod
