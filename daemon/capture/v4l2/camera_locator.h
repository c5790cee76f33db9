// SPDX-License-Identifier: BSD-3-Clause
// From a camera's name in the configuration to its video node.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/sync/pairing.h"
#include "daemon/capture/v4l2/camera_fault.h"
#include "daemon/capture/v4l2/v4l2_pair_state.h"
#include "daemon/capture/v4l2/video_system.h"

namespace stereod::v4l2 {

/// Finds the node that @p name refers to now. Returns nothing on success. A name is
///   a path: /dev/v4l/by-path/… (a port: left stays left after a replug), /dev/v4l/by-id/…, or /dev/videoN;
///   a file name in by-path or by-id;
///   serial:S, the camera with this USB serial number;
///   auto: the first (left) or second (right) camera, in the order of their ports.
/// Writes @p node and a name that refers to the same camera from now on: for auto the first link of the node,
/// else @p name.
std::optional<CameraFault> find_camera(VideoSystem& system, Side side, const std::string& name,
                                       std::string& node, std::string& stable_name);

/// Finds one camera again and again, and claims its device for one side; used by that camera's thread.
class CameraLocator {
 public:
  /// @p system and @p pair must outlive this.
  CameraLocator(VideoSystem& system, V4l2PairState& pair, Side side, std::string name)
      : system_(system), pair_(pair), side_(side), name_(std::move(name)) {}

  /// Finds the camera and claims its device. Returns nothing on success. @p has_streamed: a camera that is
  /// not found was unplugged.
  std::optional<CameraFault> locate(bool has_streamed);

  /// Returns the node that locate() found last.
  const std::string& node() const noexcept { return node_; }

  /// Searches from now on for the camera that locate() found last, even if the configured name is `auto`.
  void keep_camera() { name_ = stable_name_; }

  /// Returns true for half a second after the other camera was found to have claimed the same device. After
  /// ports were swapped, the other camera needs a moment to notice that it has lost its device.
  bool conflict_may_pass(std::int64_t now_ns) noexcept;

 private:
  VideoSystem& system_;
  V4l2PairState& pair_;
  const Side side_;
  std::string name_;         // what to search for
  std::string stable_name_;  // of the camera found last
  std::string node_;
  std::int64_t conflict_since_ns_ = 0;  // 0 = no conflict
};

}  // namespace stereod::v4l2
