// stereod.yaml: what the daemon is told.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/match/options.h"
#include "core/perception/obstacle_scan.h"
#include "core/rectify/rectify_map.h"

namespace stereod {

/// Where frames come from.
enum class SourceKind {
  kV4l2,       ///< two cameras
  kReplay,     ///< recorded images
  kSynthetic,  ///< a rendered scene with known depth
  kLog,        ///< raw images in an LCM log
};

/// What the rendered cameras of source: synthetic see.
enum class SceneKind {
  kRoom,   ///< a room with boxes that stand and move
  kBoard,  ///< a chessboard that is held before them as for calibrating
};

/// How the cameras' exposure is kept.
enum class ExposureMode {
  kAuto,    ///< each camera as it likes
  kLock,    ///< the same for both, and it stays as it is
  kFollow,  ///< the left camera's automatic one, copied to the right camera
};

/// When the right camera is restarted so that both expose at the same time.
enum class SyncMode {
  kNone,
  kStart,   ///< when both have begun to stream
  kAlways,  ///< also when they have drifted apart
};

/// A camera's control by its name, such as gain.
using ControlValues = std::map<std::string, int>;

/// source: v4l2
struct V4l2Config {
  std::string left = "auto", right = "auto";  ///< see find_camera()
  int width = 640, height = 480;
  std::string format = "auto";
  ExposureMode exposure = ExposureMode::kFollow;
  ControlValues controls, left_controls, right_controls;  ///< of both, and of one camera more
  SyncMode sync = SyncMode::kStart;
  double max_sync_skew_ms = 3;
  int sync_attempts = 8;
  friend bool operator==(const V4l2Config&, const V4l2Config&) = default;
};

struct CamerasConfig {
  SourceKind source = SourceKind::kSynthetic;
  double fps = 30;         ///< 0…240; 0: the next frame once the last one is matched and sent
  double max_skew_ms = 0;  ///< tolerance of pairing; 0 stands for half a frame
  V4l2Config v4l2;
  // source: replay
  std::filesystem::path replay_left, replay_right;  ///< one pair of images, or
  std::filesystem::path replay_directory;           ///< a directory of numbered pairs
  bool replay_loop = true;
  // source: log
  std::filesystem::path log_file;
  std::string log_prefix = "STEREO";  ///< of the channels in the log
  bool log_loop = false;
  // source: synthetic
  SceneKind scene = SceneKind::kRoom;
  int width = 640, height = 480;
  double skew_ms = 0;  ///< how much later the right camera exposes

  /// The largest difference of capture times within a pair, ns.
  std::int64_t pairing_tolerance_ns() const;
  friend bool operator==(const CamerasConfig&, const CamerasConfig&) = default;
};

struct RectifyConfig {
  Interpolation interpolation = Interpolation::kBilinear;
  std::optional<double> alpha;  ///< see with_alpha(); nothing: as the calibration has it
};

/// The rectified left image on the wire.
struct LeftImageConfig {
  bool enabled = false;
  bool jpeg = true;  ///< false: every gray value, in several datagrams
  double per_second = 15;
};

struct LcmConfig {
  std::string url;                      ///< empty: LCM_DEFAULT_URL, or this machine only
  std::string prefix = "STEREO";        ///< of every channel
  std::optional<int> rows_per_message;  ///< nothing (auto): usual_rows_per_message()
  double pacing = 0.3;                  ///< share of the frame time over which a frame's rows are spread out
  bool raw_images = false;              ///< publish what the cameras see
  double raw_images_per_second = 2;
  LeftImageConfig left_image;
};

/// What of the disparity is published.
struct PublishConfig {
  int left = 0, top = 0;                   ///< first column and row of the rectified image, px
  int width = 0, height = 0;               ///< px of the rectified image; 0: up to its edge
  int decimation_x = 1, decimation_y = 1;  ///< every so many-th
  bool depth = false;                      ///< depth in millimeters
  bool cloud = false;                      ///< points
  int cloud_decimation = 8;                ///< of every so many-th column and row
};

struct ScanConfig {
  bool enabled = false;
  bool fit_ground = true;  ///< false: `ground` is where the floor is
  GroundPlane ground;
  ScanOptions options;
};

/// How the kernel is to run the threads that match.
struct SchedulingConfig {
  int priority = 0;       ///< SCHED_FIFO's, 1…99; 0: as other programs
  std::vector<int> cpus;  ///< on which they may run; empty: on all
};

struct Config {
  CamerasConfig cameras;
  std::filesystem::path calibration;  ///< empty: the synthetic scene's own, or none
  RectifyConfig rectify;
  MatcherOptions matcher = *matcher_preset("robust");
  int workers = 0;  ///< 0: one for each core
  SchedulingConfig scheduling;
  LcmConfig lcm;
  PublishConfig publish;
  ScanConfig scan;
  std::string log_level = "info";

  /// How many workers that is on this machine.
  int worker_count() const;
};

/// Reads a configuration file, strictly. Throws FileError: "file:line: key: what was found, what is allowed".
Config read_config(const std::filesystem::path& file);

/// "file:line: key" for a complaint about a key like "matcher.isa", "file: key" if it does not stand there.
std::string place_of(const std::filesystem::path& file, const std::string& key);

std::string_view name_of(SourceKind kind);

}  // namespace stereod
