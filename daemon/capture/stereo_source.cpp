// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/capture/stereo_source.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "core/base/text.h"
#include "core/geometry/stereo_rectification.h"
#include "daemon/base/file_error.h"
#include "daemon/capture/replay/log_source.h"
#include "daemon/capture/replay/replay_source.h"
#include "daemon/capture/synthetic/synthetic_source.h"
#include "daemon/config/calibration_file.h"

namespace stereod {
namespace {

StereoSource open_replay_sources(const CamerasConfig& cameras) {
  const ReplayOptions options{cameras.fps, cameras.replay_loop};
  const bool directory = !cameras.replay_directory.empty();
  ReplaySources replay = directory ? open_replay(cameras.replay_directory, options)
                                   : open_replay(cameras.replay_left, cameras.replay_right, options);
  StereoSource source;
  source.left = std::move(replay.left);
  source.right = std::move(replay.right);
  source.left_name = "replay of " + (directory ? cameras.replay_directory : cameras.replay_left).string();
  source.right_name = "replay of " + (directory ? cameras.replay_directory : cameras.replay_right).string();
  return source;
}

StereoSource open_log_sources(const CamerasConfig& cameras) {
  LogSources log = open_log(cameras.log_file, {cameras.log_prefix, cameras.fps > 0, cameras.log_loop});
  if (log.unpaired > 0) {
    spdlog::warn("{}: {} raw images without a partner in the log are not replayed", cameras.log_file.string(),
                 log.unpaired);
  }
  StereoSource source;
  source.left = std::move(log.left);
  source.right = std::move(log.right);
  source.left_name = source.right_name = "log " + cameras.log_file.string();
  return source;
}

StereoSource open_synthetic_sources(const CamerasConfig& cameras) {
  SyntheticOptions options;
  options.size = {cameras.width, cameras.height};
  options.fps = cameras.fps;
  options.board = cameras.scene == SceneKind::kBoard;
  options.skew = std::chrono::microseconds(static_cast<std::int64_t>(cameras.skew_ms * 1000));
  SyntheticPair pair = make_synthetic_pair(options);
  StereoSource source;
  source.left = std::move(pair.left);
  source.right = std::move(pair.right);
  source.left_name = source.right_name = options.board ? "synthetic board" : "synthetic scene";
  source.scene_calibration = std::move(pair.calibration);
  return source;
}

void log_camera(v4l2::LogLevel level, const std::string& sentence) {
  spdlog::log(level == v4l2::LogLevel::kWarning ? spdlog::level::warn : spdlog::level::info, "{}", sentence);
}

StereoSource open_uncalibrated(const CamerasConfig& cameras) {
  switch (cameras.source) {
    case SourceKind::kV4l2:
      return make_v4l2_stereo_source(cameras, v4l2::make_kernel_video_system(), log_camera);
    case SourceKind::kReplay:
      return open_replay_sources(cameras);
    case SourceKind::kSynthetic:
      return open_synthetic_sources(cameras);
    case SourceKind::kLog:
      return open_log_sources(cameras);
  }
  return {};
}

}  // namespace

StereoSource make_v4l2_stereo_source(const CamerasConfig& cameras, std::unique_ptr<v4l2::VideoSystem> system,
                                     const v4l2::CameraLog& log) {
  const auto pair = std::make_shared<v4l2::V4l2PairState>(cameras);
  StereoSource source;
  source.left = std::make_unique<v4l2::V4l2Camera>(*system, pair, Side::kLeft, cameras, log);
  source.right = std::make_unique<v4l2::V4l2Camera>(*system, pair, Side::kRight, cameras, log);
  source.left_name = cameras.v4l2.left;
  source.right_name = cameras.v4l2.right;
  source.cameras = pair;
  source.video = std::move(system);
  return source;
}

std::optional<Calibration> calibration_for(const Config& config, const StereoSource& source) {
  std::optional<Calibration> calibration = source.scene_calibration;
  if (!config.calibration.empty()) calibration = read_calibration(config.calibration);
  const Size size = source.left->frame_size();
  if (calibration && calibration->image != size) {
    throw FileError(config.calibration.string() + ": the calibration is for images of " +
                    to_string(calibration->image) + ", the cameras give " + to_string(size) +
                    "; calibrate at that size, or set the cameras to the calibration's");
  }
  if (calibration && config.rectify.alpha) {
    try {
      calibration = with_alpha(*calibration, *config.rectify.alpha);
    } catch (const std::invalid_argument& refused) {
      throw FileError(config.calibration.string() + ": " + refused.what());
    }
  }
  return calibration;
}

StereoSource open_stereo_source(const Config& config) {
  StereoSource source = open_uncalibrated(config.cameras);
  source.calibration = calibration_for(config, source);
  return source;
}

}  // namespace stereod
