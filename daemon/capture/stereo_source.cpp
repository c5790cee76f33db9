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

StereoSource open_replay_rig(const CamerasConfig& cameras) {
  const ReplayOptions options{cameras.fps, cameras.replay_loop};
  const bool directory = !cameras.replay_directory.empty();
  ReplaySources sources = directory ? open_replay(cameras.replay_directory, options)
                                    : open_replay(cameras.replay_left, cameras.replay_right, options);
  StereoSource rig;
  rig.left = std::move(sources.left);
  rig.right = std::move(sources.right);
  rig.left_name = "replay of " + (directory ? cameras.replay_directory : cameras.replay_left).string();
  rig.right_name = "replay of " + (directory ? cameras.replay_directory : cameras.replay_right).string();
  return rig;
}

StereoSource open_log_rig(const CamerasConfig& cameras) {
  LogSources sources = open_log(cameras.log_file, {cameras.log_prefix, cameras.fps > 0, cameras.log_loop});
  if (sources.unpaired > 0) {
    spdlog::warn("{}: {} raw images have no partner in the log and are not replayed",
                 cameras.log_file.string(), sources.unpaired);
  }
  StereoSource rig;
  rig.left = std::move(sources.left);
  rig.right = std::move(sources.right);
  rig.left_name = rig.right_name = "log " + cameras.log_file.string();
  return rig;
}

StereoSource open_synthetic_rig(const CamerasConfig& cameras) {
  SyntheticOptions options;
  options.size = {cameras.width, cameras.height};
  options.fps = cameras.fps;
  options.board = cameras.scene == SceneKind::kBoard;
  options.skew = std::chrono::microseconds(static_cast<std::int64_t>(cameras.skew_ms * 1000));
  SyntheticPair pair = make_synthetic_pair(options);
  StereoSource rig;
  rig.left = std::move(pair.left);
  rig.right = std::move(pair.right);
  rig.left_name = rig.right_name = options.board ? "synthetic board" : "synthetic scene";
  rig.scene_calibration = std::move(pair.calibration);
  return rig;
}

void log_camera(LogLevel level, const std::string& sentence) {
  spdlog::log(level == LogLevel::kWarning ? spdlog::level::warn : spdlog::level::info, "{}", sentence);
}

StereoSource open_uncalibrated(const CamerasConfig& cameras) {
  switch (cameras.source) {
    case SourceKind::kV4l2:
      return make_v4l2_stereo_source(cameras, make_kernel_video_system(), log_camera);
    case SourceKind::kReplay:
      return open_replay_rig(cameras);
    case SourceKind::kSynthetic:
      return open_synthetic_rig(cameras);
    case SourceKind::kLog:
      return open_log_rig(cameras);
  }
  return {};
}

}  // namespace

StereoSource make_v4l2_stereo_source(const CamerasConfig& cameras, std::unique_ptr<VideoSystem> system,
                                     const CameraLog& log) {
  const auto pair = std::make_shared<V4l2PairState>(cameras);
  StereoSource rig;
  rig.left = std::make_unique<V4l2Camera>(*system, pair, Side::kLeft, cameras, log);
  rig.right = std::make_unique<V4l2Camera>(*system, pair, Side::kRight, cameras, log);
  rig.left_name = cameras.v4l2.left;
  rig.right_name = cameras.v4l2.right;
  rig.cameras = pair;
  rig.video = std::move(system);
  return rig;
}

std::optional<Calibration> calibration_for(const Config& config, const StereoSource& rig) {
  std::optional<Calibration> calibration = rig.scene_calibration;
  if (!config.calibration.empty()) calibration = read_calibration(config.calibration);
  const Size size = rig.left->frame_size();
  if (calibration && calibration->image != size) {
    throw FileError(config.calibration.string() + ": the calibration is for images of " +
                    to_string(calibration->image) + ", the cameras give " + to_string(size) +
                    "; calibrate at that size or set the cameras to the calibration's");
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
  StereoSource rig = open_uncalibrated(config.cameras);
  rig.calibration = calibration_for(config, rig);
  return rig;
}

}  // namespace stereod
