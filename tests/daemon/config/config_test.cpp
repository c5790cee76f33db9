// SPDX-License-Identifier: BSD-3-Clause
// Tests reading stereod.yaml.
#include "tests/daemon/config/config_file.h"

#include <numbers>
#include <string>

#include "daemon/config/yaml_section.h"

namespace stereod {
namespace {

TEST_F(ConfigFile, MinimalFile_GivesDefaults) {
  const Config config = read("cameras:\n  source: synthetic\n");
  EXPECT_EQ(config.cameras.source, SourceKind::kSynthetic);
  EXPECT_EQ(config.cameras.fps, 30);
  EXPECT_EQ(config.matcher.disparities, 64);
  EXPECT_EQ(config.matcher.uniqueness_ratio, matcher_preset("robust")->uniqueness_ratio);
  EXPECT_EQ(config.lcm.prefix, "STEREO");
  EXPECT_GE(config.worker_count(), 1);
}

TEST_F(ConfigFile, SemiglobalKeys_Read) {
  const MatcherOptions options = read(R"(
cameras: {source: synthetic}
matcher: {preset: fast, method: semiglobal, grid: fine, p1: 7, p2: 56, census_weight: 3, gradient_limit: 18, hole_filling: true}
)")
                                     .matcher;
  EXPECT_EQ(options.method, Method::kSemiglobal);
  EXPECT_EQ(options.grid, Grid::kFine);
  EXPECT_EQ(options.p1, 7);
  EXPECT_EQ(options.p2, 56);
  EXPECT_EQ(options.census_weight, 3);
  EXPECT_EQ(options.gradient_limit, 18);
  EXPECT_TRUE(options.hole_filling);
}

TEST_F(ConfigFile, EveryKey_Read) {
  const Config config = read(R"(
cameras:
  source: replay
  fps: 12.5
  max_skew_ms: 7
  replay: {left: l.png, right: /abs/r.png, loop: false}
  log: {file: field.lcm, prefix: REAR, loop: true}
  synthetic: {scene: board, width: 320, height: 240, skew_ms: 3}
calibration: calibration.yaml
matcher:
  preset: fast
  min_disparity: 3
  disparities: 50
  window: 9
  prefilter: xsobel
  prefilter_cap: 20
  texture_threshold: 11
  uniqueness_ratio: 12
  left_right_max_diff: 2
  subpixel: false
  median: 5
  speckle_size: 50
  speckle_max_diff: 2
  implementation: sliding
  isa: scalar
  cache: small
rectify: {interpolation: nearest, alpha: 0.25}
workers: 3
scheduling: {priority: 10, cpus: "0,2-4"}
lcm: {url: "memq://", prefix: FRONT, rows_per_message: 8, pacing: 0.5, left_image: gray, left_images_per_second: 3}
publish: {region: {left: 8, top: 100, width: 600, height: 300}, decimation_x: 2, decimation_y: 3,
          depth: true, cloud: true, cloud_decimation: 4}
scan:
  enabled: true
  ground: fixed
  camera_height_m: 0.31
  camera_pitch_deg: 18
  min_obstacle_height_m: 0.03
  max_obstacle_height_m: 0.7
  max_range_m: 5
  rays: 33
  min_support: 44
  stop_distance_m: 0.6
  stop_width_m: 0.5
log: {level: debug}
)");
  EXPECT_EQ(config.cameras.source, SourceKind::kReplay);
  EXPECT_EQ(config.cameras.fps, 12.5);
  EXPECT_EQ(config.cameras.pairing_tolerance_ns(), 7'000'000);
  EXPECT_EQ(config.cameras.replay_left, directory_ / "l.png") << "relative to the configuration file";
  EXPECT_EQ(config.cameras.replay_right, "/abs/r.png");
  EXPECT_FALSE(config.cameras.replay_loop);
  EXPECT_EQ(config.cameras.width, 320);
  EXPECT_EQ(config.cameras.skew_ms, 3);
  EXPECT_EQ(config.cameras.scene, SceneKind::kBoard);
  EXPECT_EQ(config.calibration, directory_ / "calibration.yaml");
  EXPECT_EQ(config.matcher.min_disparity, 3);
  EXPECT_EQ(config.matcher.disparities, 50);
  EXPECT_EQ(config.matcher.window, 9);
  EXPECT_EQ(config.matcher.prefilter_cap, 20);
  EXPECT_EQ(config.matcher.texture_threshold, 11);
  EXPECT_EQ(config.matcher.uniqueness_ratio, 12);
  EXPECT_EQ(config.matcher.left_right_max_diff, 2);
  EXPECT_FALSE(config.matcher.subpixel);
  EXPECT_EQ(config.matcher.median, 5);
  EXPECT_EQ(config.matcher.speckle_size, 50);
  EXPECT_EQ(config.matcher.speckle_max_diff, 2);
  EXPECT_EQ(config.matcher.implementation, Implementation::kSliding);
  EXPECT_EQ(config.matcher.isa, Isa::kScalar);
  EXPECT_EQ(config.matcher.cache, CacheUse::kSmall);
  EXPECT_EQ(config.rectify.interpolation, Interpolation::kNearest);
  EXPECT_EQ(config.rectify.alpha, 0.25);
  EXPECT_EQ(config.worker_count(), 3);
  EXPECT_EQ(config.scheduling.priority, 10);
  EXPECT_EQ(config.scheduling.cpus, (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(config.lcm.url, "memq://");
  EXPECT_EQ(config.lcm.prefix, "FRONT");
  EXPECT_EQ(config.lcm.rows_per_message, 8);
  EXPECT_EQ(config.lcm.pacing, 0.5);
  EXPECT_EQ(config.cameras.log_file, directory_ / "field.lcm");
  EXPECT_EQ(config.cameras.log_prefix, "REAR");
  EXPECT_TRUE(config.cameras.log_loop);
  EXPECT_TRUE(config.lcm.left_image.enabled);
  EXPECT_FALSE(config.lcm.left_image.jpeg);
  EXPECT_EQ(config.lcm.left_image.per_second, 3);
  EXPECT_EQ(config.publish.left, 8);
  EXPECT_EQ(config.publish.top, 100);
  EXPECT_EQ(config.publish.width, 600);
  EXPECT_EQ(config.publish.height, 300);
  EXPECT_EQ(config.publish.decimation_x, 2);
  EXPECT_EQ(config.publish.decimation_y, 3);
  EXPECT_TRUE(config.publish.depth);
  EXPECT_TRUE(config.publish.cloud);
  EXPECT_EQ(config.publish.cloud_decimation, 4);
  EXPECT_TRUE(config.scan.enabled);
  EXPECT_FALSE(config.scan.fit_ground);
  EXPECT_EQ(config.scan.ground.height_m, 0.31);
  EXPECT_DOUBLE_EQ(config.scan.ground.pitch_rad, std::numbers::pi / 10);
  EXPECT_EQ(config.scan.options.min_obstacle_height_m, 0.03);
  EXPECT_EQ(config.scan.options.max_obstacle_height_m, 0.7);
  EXPECT_EQ(config.scan.options.max_range_m, 5);
  EXPECT_EQ(config.scan.options.rays, 33);
  EXPECT_EQ(config.scan.options.min_support, 44);
  EXPECT_EQ(config.scan.options.stop_distance_m, 0.6);
  EXPECT_EQ(config.scan.options.stop_width_m, 0.5);
  EXPECT_EQ(config.log_level, "debug");
}

TEST_F(ConfigFile, CameraKeys_Read) {
  const Config config = read(R"(
cameras:
  source: v4l2
  fps: 15
  v4l2:
    left: /dev/v4l/by-path/a
    right: serial:77
    width: 1280
    height: 720
    format: mjpeg
    exposure: lock
    controls: {gain: 5, power_line_frequency: 1}
    left_controls: {brightness: -3}
    right_controls: {brightness: 4}
    sync: always
    max_sync_skew_ms: 1.5
    sync_attempts: 3
lcm: {raw_images: true, raw_images_per_second: 0.5}
)");
  const V4l2Config& v4l2 = config.cameras.v4l2;
  EXPECT_EQ(config.cameras.source, SourceKind::kV4l2);
  EXPECT_EQ(v4l2.left, "/dev/v4l/by-path/a");
  EXPECT_EQ(v4l2.right, "serial:77");
  EXPECT_EQ(v4l2.width, 1280);
  EXPECT_EQ(v4l2.height, 720);
  EXPECT_EQ(v4l2.format, "mjpeg");
  EXPECT_EQ(v4l2.exposure, ExposureMode::kLock);
  EXPECT_EQ(v4l2.controls, (ControlValues{{"gain", 5}, {"power_line_frequency", 1}}));
  EXPECT_EQ(v4l2.left_controls, (ControlValues{{"brightness", -3}}));
  EXPECT_EQ(v4l2.right_controls, (ControlValues{{"brightness", 4}}));
  EXPECT_EQ(v4l2.sync, SyncMode::kAlways);
  EXPECT_EQ(v4l2.max_sync_skew_ms, 1.5);
  EXPECT_EQ(v4l2.sync_attempts, 3);
  EXPECT_TRUE(config.lcm.raw_images);
  EXPECT_EQ(config.lcm.raw_images_per_second, 0.5);
}

TEST_F(ConfigFile, NoTolerance_IsHalfAFrame) {
  EXPECT_EQ(read("cameras: {source: synthetic, fps: 50}").cameras.pairing_tolerance_ns(), 10'000'000);
}

TEST_F(ConfigFile, MissingFileAndDirectory_Distinguished) {
  EXPECT_EQ(file_error_of([] { read_config("/nowhere/stereod.yaml"); }),
            "/nowhere/stereod.yaml: the file does not exist");
  EXPECT_EQ(file_error_of([&] { read_config(directory_.path()); }),
            directory_.path().string() + ": is a directory; a file is needed");
}

// A link to itself cannot be followed, by root neither.
TEST_F(ConfigFile, UnreachableFile_NotCalledMissing) {
  const std::filesystem::path link = directory_.path() / "link.yaml";
  std::filesystem::create_symlink("link.yaml", link);
  EXPECT_EQ(file_error_of([&] { read_config(link); }).find(link.string() + ": cannot be reached ("), 0U);
}

TEST_F(ConfigFile, NaiveSemiglobal_IsRefusedByTheDaemonOnly) {
  const Config config = read("cameras: {source: synthetic}\nmatcher: {implementation: naive}\n");
  const auto problem = problem_for_daemon(config);
  ASSERT_TRUE(problem.has_value());
  EXPECT_EQ(problem->key, "matcher.implementation");
  EXPECT_TRUE(problem->message.starts_with("found naive with method semiglobal, allowed simd"))
      << problem->message;
  EXPECT_EQ(problem_for_daemon(read("cameras: {source: synthetic}\n")), std::nullopt);
  EXPECT_EQ(problem_for_daemon(
                read("cameras: {source: synthetic}\nmatcher: {preset: fast, implementation: naive}\n")),
            std::nullopt);
}

TEST(EditDistance, TwoWords_CountsChanges) {
  EXPECT_EQ(edit_distance("window", "window"), 0u);
  EXPECT_EQ(edit_distance("windw", "window"), 1u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

}  // namespace
}  // namespace stereod
