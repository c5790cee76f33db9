// SPDX-License-Identifier: BSD-3-Clause
// Searching for cameras by port, serial number, or automatically.
#include "daemon/capture/v4l2/camera_locator.h"

#include <algorithm>
#include <cerrno>
#include <vector>

#include "daemon/capture/v4l2/video_device.h"

namespace stereod::v4l2 {
namespace {

constexpr std::string_view kSerial = "serial:";

/// Returns 0 if the node captures images, EACCES or EPERM if the user may not open it, else another errno
/// value.
int capture_error(VideoSystem& system, const VideoNode& node) {
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
    const auto is_same_camera = [&](const VideoNode& other) {
      return system.camera_id(other.node) == system.camera_id(candidate.node);
    };
    const int error = capture_error(system, candidate);
    if (is_refusal(error) && refused.empty()) refused = candidate.node;
    if (error != 0) continue;
    if (std::none_of(cameras.begin(), cameras.end(), is_same_camera)) cameras.push_back(candidate);
  }
  if (cameras.size() < 2 && !refused.empty()) return fault_of(SetupStage::kOpen, EACCES, refused);
  if (cameras.size() < 2) {
    const std::string found = cameras.empty() ? "none is" : "only " + cameras[0].node + " is";
    return CameraFault{
        CameraReason::kAmbiguous, SetupStage::kFind, 0,
        "device auto needs two cameras, but " + found + " plugged in; plug them in, or name the devices"};
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
    const int error = serial ? capture_error(system, candidate) : 0;
    if (is_refusal(error)) return fault_of(SetupStage::kOpen, error, candidate.node);
    if (error != 0) continue;
    node = candidate.node;
    return std::nullopt;
  }
  return not_found(serial ? "no camera with the serial number " + name.substr(kSerial.size()) + "; plug it in"
                          : "no camera is called " + name + "; plug it in, or see 'stereod --list-cameras'");
}

std::optional<CameraFault> CameraLocator::locate(bool has_streamed) {
  if (auto fault = find_camera(system_, side_, name_, node_, stable_name_)) {
    pair_.claim_device(side_, "");
    if (has_streamed && fault->reason == CameraReason::kNotFound) {
      fault->reason = CameraReason::kUnplugged;
      fault->sentence = "was unplugged: " + fault->sentence;
    }
    return fault;
  }
  if (!pair_.claim_device(side_, system_.camera_id(node_))) {
    return CameraFault{CameraReason::kSameCamera, SetupStage::kFind, 0,
                       node_ + " belongs to the camera that is the " +
                           (side_ == Side::kLeft ? "right" : "left") +
                           " one; name two cameras in cameras.v4l2"};
  }
  conflict_since_ns_ = 0;
  return std::nullopt;
}

bool CameraLocator::conflict_may_pass(std::int64_t now_ns) noexcept {
  constexpr std::int64_t kPatience = 500'000'000;
  if (conflict_since_ns_ == 0) conflict_since_ns_ = now_ns;
  return now_ns - conflict_since_ns_ < kPatience;
}

}  // namespace stereod::v4l2
