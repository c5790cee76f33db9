// SPDX-License-Identifier: BSD-3-Clause
// Holds and reads the configuration of the daemon, stereod.yaml. Ranges and units are in the tables of sections.h.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/option.h"
#include "core/base/problem.h"
#include "core/match/options.h"
#include "core/perception/obstacle_scan.h"
#include "core/rectify/rectify_map.h"

namespace stereod {

/// Selects where frames come from.
enum class SourceKind {
  kV4l2,       ///< two cameras
  kReplay,     ///< recorded images
  kSynthetic,  ///< a rendered scene of known depth
  kLog,        ///< raw images in an LCM log
};

/// Selects what the rendered cameras of source: synthetic see.
enum class SceneKind {
  kRoom,   ///< a room with boxes that stand and move
  kBoard,  ///< a chessboard that moves in front of the cameras as for calibrating
};

/// Selects who controls the cameras' exposure.
enum class ExposureMode {
  kAuto,    ///< each camera its own
  kFollow,  ///< the left camera; its exposure is copied to the right camera
  kLock,    ///< the left camera for two seconds; then both keep that exposure
};

/// Selects when the camera that started last is restarted so that both expose at the same time.
enum class SyncMode {
  kNone,
  kStart,   ///< once, after both cameras stream
  kAlways,  ///< again when the difference exceeds 2 × max_sync_skew_ms
};

/// Holds values of camera controls by name, such as gain.
using ControlValues = NamedIntegers;

/// Holds cameras.v4l2.
struct V4l2Config {
  std::string left = "auto", right = "auto";  ///< see find_camera()
  int width = 640, height = 480;
  std::string format = "auto";
  ExposureMode exposure = ExposureMode::kFollow;
  ControlValues controls, left_controls, right_controls;  ///< of both cameras, and of one camera more
  SyncMode sync = SyncMode::kStart;
  double max_sync_skew_ms = 3;
  int sync_attempts = 8;
  friend bool operator==(const V4l2Config&, const V4l2Config&) = default;
};

struct CamerasConfig {
  SourceKind source = SourceKind::kSynthetic;
  double fps = 30;         ///< 0: the next frame once the previous one is matched and sent
  double max_skew_ms = 0;  ///< tolerance of pairing; 0: half a frame period
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
  double skew_ms = 0;  ///< right exposure − left exposure

  /// Returns the maximum difference of the capture times of a pair [ns].
  std::int64_t pairing_tolerance_ns() const;
  friend bool operator==(const CamerasConfig&, const CamerasConfig&) = default;
};

struct RectifyConfig {
  Interpolation interpolation = Interpolation::kBilinear;
  std::optional<double> alpha;  ///< see with_alpha(); nothing: as the calibration has it
};

/// Holds how the rectified left image is published.
struct LeftImageConfig {
  bool enabled = false;
  bool jpeg = true;  ///< false: uncompressed, in several datagrams
  double per_second = 15;
};

struct LcmConfig {
  std::string url;                      ///< empty: LCM_DEFAULT_URL, or this machine only
  std::string prefix = "STEREO";        ///< of every channel
  std::optional<int> rows_per_message;  ///< nothing (auto): usual_rows_per_message()
  double pacing = 0.3;                  ///< share of the frame period over which the rows of a frame are sent
  bool raw_images = false;              ///< publish the cameras' images
  double raw_images_per_second = 2;
  LeftImageConfig left_image;
};

/// Holds which part of the disparity image is published, and what is derived from it.
struct PublishConfig {
  int left = 0, top = 0;                   ///< first column and row of the rectified image [px]
  int width = 0, height = 0;               ///< size of the region [px]; 0: up to the edge
  int decimation_x = 1, decimation_y = 1;  ///< every n-th column and row is sent
  bool depth = false;                      ///< also depth in millimeters
  bool cloud = false;                      ///< also a point cloud
  int cloud_decimation = 8;                ///< every n-th column and row of it
};

struct ScanConfig {
  bool enabled = false;
  bool fit_ground = true;  ///< false: `ground` is where the floor is
  GroundPlane ground;
  ScanOptions options;
};

/// Holds how the kernel runs the matching threads.
struct SchedulingConfig {
  int priority = 0;       ///< of SCHED_FIFO; 0: the normal scheduling class
  std::vector<int> cpus;  ///< on which they may run; empty: all
};

struct Config {
  CamerasConfig cameras;
  std::filesystem::path calibration;  ///< empty: that of the synthetic scene, or none
  RectifyConfig rectify;
  MatcherOptions matcher = *matcher_preset("robust");
  int workers = 0;  ///< 0: one for each CPU
  SchedulingConfig scheduling;
  LcmConfig lcm;
  PublishConfig publish;
  ScanConfig scan;
  std::string log_level = "info";

  /// Returns the number of workers on this machine.
  int worker_count() const;
};

/// Reads a configuration file strictly.
/// @throws FileError "file:line: key: what was found, what is allowed".
Config read_config(const std::filesystem::path& file);

/// Returns what the daemon refuses although the matcher supports it, with the full key.
std::optional<Problem> problem_for_daemon(const Config& config);

/// Returns "file:line: key" for a complaint about a key such as "matcher.isa", "file: key" if the file lacks the key.
std::string place_of(const std::filesystem::path& file, const std::string& key);

std::string_view name_of(SourceKind kind);

}  // namespace stereod
