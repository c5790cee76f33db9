#include "daemon/capture/rig.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "core/stereo_rectification.h"
#include "daemon/capture/log_source.h"
#include "daemon/capture/replay_source.h"
#include "daemon/capture/synthetic_source.h"
#include "daemon/config/calibration_file.h"
#include "daemon/config/file_error.h"

namespace stereod {
namespace {

std::string in_words(Size size) { return std::to_string(size.width) + "×" + std::to_string(size.height); }

Rig open_replay_rig(const CamerasConfig& cameras) {
  const ReplayOptions options{cameras.fps, cameras.replay_loop};
  const bool folder = !cameras.replay_folder.empty();
  ReplaySources sources = folder ? open_replay(cameras.replay_folder, options)
                                 : open_replay(cameras.replay_left, cameras.replay_right, options);
  Rig rig;
  rig.left = std::move(sources.left);
  rig.right = std::move(sources.right);
  rig.left_name = "replay of " + (folder ? cameras.replay_folder : cameras.replay_left).string();
  rig.right_name = "replay of " + (folder ? cameras.replay_folder : cameras.replay_right).string();
  return rig;
}

Rig open_log_rig(const CamerasConfig& cameras) {
  LogSources sources = open_log(cameras.log_file, {cameras.log_prefix, cameras.fps > 0, cameras.log_loop});
  if (sources.unpaired > 0) {
    spdlog::warn("{}: {} raw images have no partner in the log and are not replayed",
                 cameras.log_file.string(), sources.unpaired);
  }
  Rig rig;
  rig.left = std::move(sources.left);
  rig.right = std::move(sources.right);
  rig.left_name = rig.right_name = "log " + cameras.log_file.string();
  return rig;
}

Rig open_synthetic_rig(const CamerasConfig& cameras) {
  SyntheticOptions options;
  options.size = {cameras.width, cameras.height};
  options.fps = cameras.fps;
  options.board = cameras.scene == SceneKind::kBoard;
  options.skew = std::chrono::microseconds(static_cast<std::int64_t>(cameras.skew_ms * 1000));
  SyntheticPair pair = make_synthetic_pair(options);
  Rig rig;
  rig.left = std::move(pair.left);
  rig.right = std::move(pair.right);
  rig.left_name = rig.right_name = options.board ? "synthetic board" : "synthetic scene";
  rig.scene_calibration = std::move(pair.calibration);
  return rig;
}

void log_camera(LogLevel level, const std::string& sentence) {
  spdlog::log(level == LogLevel::kWarning ? spdlog::level::warn : spdlog::level::info, "{}", sentence);
}

Rig open_uncalibrated(const CamerasConfig& cameras) {
  switch (cameras.source) {
    case SourceKind::kV4l2:
      return make_v4l2_rig(cameras, make_kernel_video_system(), log_camera);
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

Rig make_v4l2_rig(const CamerasConfig& cameras, std::unique_ptr<VideoSystem> system, const CameraLog& log) {
  const auto pair = std::make_shared<CameraPair>(cameras);
  Rig rig;
  rig.left = std::make_unique<V4l2Camera>(*system, pair, Side::kLeft, cameras, log);
  rig.right = std::make_unique<V4l2Camera>(*system, pair, Side::kRight, cameras, log);
  rig.left_name = cameras.v4l2.left;
  rig.right_name = cameras.v4l2.right;
  rig.cameras = pair;
  rig.video = std::move(system);
  return rig;
}

std::optional<Calibration> calibration_for(const Config& config, const Rig& rig) {
  std::optional<Calibration> calibration = rig.scene_calibration;
  if (!config.calibration.empty()) calibration = read_calibration(config.calibration);
  const Size size = rig.left->frame_size();
  if (calibration && calibration->image != size) {
    throw FileError(config.calibration.string() + ": the calibration is for images of " +
                    in_words(calibration->image) + ", the cameras give " + in_words(size) +
                    "; calibrate at that size or set the cameras to the calibration's");
  }
  if (calibration && config.rectify.zoom) {
    try {
      calibration = zoomed(*calibration, *config.rectify.zoom);
    } catch (const std::invalid_argument& refused) {
      throw FileError(config.calibration.string() + ": " + refused.what());
    }
  }
  return calibration;
}

Rig open_rig(const Config& config) {
  Rig rig = open_uncalibrated(config.cameras);
  rig.calibration = calibration_for(config, rig);
  return rig;
}

}  // namespace stereod
