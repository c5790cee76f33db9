// SPDX-License-Identifier: BSD-3-Clause
// Two V4L2 cameras on a FakeVideo, driven by the test.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/capture/v4l2/v4l2_camera.h"
#include "tests/support/fake_video.h"

namespace stereod::v4l2 {

struct CameraBench {
  explicit CameraBench(bool real_time = false) : video(real_time) {
    FakeCamera camera;
    camera.node = "/dev/video0";
    camera.links = {"/dev/v4l/by-path/port-1", "/dev/v4l/by-id/usb-LEFT-video-index0"};
    camera.serial = "LEFT";
    left_camera = &video.add(camera);
    camera.node = "/dev/video2";
    camera.links = {"/dev/v4l/by-path/port-2", "/dev/v4l/by-id/usb-RIGHT-video-index0"};
    camera.serial = "RIGHT";
    camera.bus = "usb-0000:00:14.0-2";
    right_camera = &video.add(camera);
    config.source = SourceKind::kV4l2;
    config.fps = 30;
    config.v4l2.width = 64;
    config.v4l2.height = 48;
    config.v4l2.left = "/dev/v4l/by-path/port-1";
    config.v4l2.right = "/dev/v4l/by-path/port-2";
    config.v4l2.exposure = ExposureMode::kAuto;
    config.v4l2.sync = SyncMode::kNone;
  }

  void make() {
    const CameraLog to_log = [this](LogLevel, const std::string& sentence) { log.push_back(sentence); };
    pair = std::make_shared<V4l2PairState>(config);
    left = std::make_unique<V4l2Camera>(video, pair, Side::kLeft, config, to_log);
    right = std::make_unique<V4l2Camera>(video, pair, Side::kRight, config, to_log);
  }

  /// Calls next() until the camera lends a frame. Returns an empty lease after @p within_ms.
  FrameLease frame(V4l2Camera& camera, std::int64_t within_ms = 10'000) {
    const std::int64_t until = video.now_ns() + within_ms * 1'000'000;
    while (video.now_ns() < until) {
      if (FrameLease lease = camera.next(std::chrono::milliseconds(100))) return lease;
    }
    return {};
  }

  /// Runs both cameras for @p ms and returns the number of frames of each.
  struct Frames {
    int left = 0, right = 0;
  };
  Frames run(std::int64_t ms) {
    Frames frames;
    const std::int64_t until = video.now_ns() + ms * 1'000'000;
    while (video.now_ns() < until) {
      if (left && left->next(std::chrono::milliseconds(1))) ++frames.left;
      if (right && right->next(std::chrono::milliseconds(1))) ++frames.right;
    }
    return frames;
  }

  FakeVideo video;
  FakeCamera* left_camera = nullptr;
  FakeCamera* right_camera = nullptr;
  CamerasConfig config;
  std::vector<std::string> log;
  std::shared_ptr<V4l2PairState> pair;
  std::unique_ptr<V4l2Camera> left, right;
};

}  // namespace stereod::v4l2
