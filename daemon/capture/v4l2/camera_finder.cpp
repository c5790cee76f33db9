#include "daemon/capture/v4l2/camera_finder.h"

#include <algorithm>
#include <cerrno>
#include <vector>

#include "daemon/capture/v4l2/video_device.h"

namespace stereod {
namespace {

constexpr std::string_view kSerial = "serial:";

/// 0 if it does; EACCES or EPERM if this user may not know; else another error.
int gives_pictures(VideoSystem& system, const VideoNode& node) {
  VideoDevice device(system);
  if (const int error = device.open(node.node, false)) return error;
  DeviceCapability capability;
  if (const int error = device.capability(capability)) return error;
  return capability.captures && capability.streams ? 0 : ENOTTY;
}

bool is_refusal(int error) { return error == EACCES || error == EPERM; }

bool is_link_name(const VideoNode& node, const std::string& name) {
  return std::any_of(node.links.begin(), node.links.end(), [&](const std::string& link) {
    return link.size() > name.size() && link.ends_with(name) && link[link.size() - name.size() - 1] == '/';
  });
}

CameraFault not_found(const std::string& sentence) {
  return {CameraReason::kNotFound, SetupStage::kFind, 0, sentence};
}

std::optional<CameraFault> find_automatically(VideoSystem& system, Side side, std::string& node,
                                              std::string& stable_name) {
  std::vector<VideoNode> cameras;
  std::string refused;
  for (const VideoNode& candidate : system.nodes()) {
    const auto is_its = [&](const VideoNode& other) {
      return system.camera_of(other.node) == system.camera_of(candidate.node);
    };
    const int error = gives_pictures(system, candidate);
    if (is_refusal(error) && refused.empty()) refused = candidate.node;
    if (error != 0) continue;
    if (std::none_of(cameras.begin(), cameras.end(), is_its)) cameras.push_back(candidate);
  }
  if (cameras.size() < 2 && !refused.empty()) return fault_of(SetupStage::kOpen, EACCES, refused);
  if (cameras.size() < 2) {
    const std::string found = cameras.empty() ? "none is" : "only " + cameras[0].node + " is";
    return CameraFault{
        CameraReason::kAmbiguous, SetupStage::kFind, 0,
        "device auto needs two cameras, and " + found + " plugged in; plug them in or name the devices"};
  }
  const VideoNode& chosen = cameras[side == Side::kLeft ? 0 : 1];
  node = chosen.node;
  stable_name = chosen.links.empty() ? chosen.node : chosen.links.front();
  return std::nullopt;
}

}  // namespace

std::optional<CameraFault> find_camera(VideoSystem& system, Side side, const std::string& name,
                                       std::string& node, std::string& stable_name) {
  stable_name = name;
  if (name == "auto") return find_automatically(system, side, node, stable_name);
  if (name.starts_with('/')) {
    node = system.resolve(name);
    if (node.empty()) return not_found("no camera at " + name + "; plug it in there");
    return std::nullopt;
  }
  const bool serial = name.starts_with(kSerial);
  for (const VideoNode& candidate : system.nodes()) {
    const bool named =
        serial ? candidate.serial == name.substr(kSerial.size()) : is_link_name(candidate, name);
    if (!named) continue;
    const int error = serial ? gives_pictures(system, candidate) : 0;
    if (is_refusal(error)) return fault_of(SetupStage::kOpen, error, candidate.node);
    if (error != 0) continue;
    node = candidate.node;
    return std::nullopt;
  }
  return not_found(serial ? "no camera with the serial number " + name.substr(kSerial.size()) + "; plug it in"
                          : "no camera is called " + name + "; plug it in, or see 'stereod --list-cameras'");
}

}  // namespace stereod
