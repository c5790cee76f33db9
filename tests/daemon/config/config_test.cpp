#include "daemon/config/config.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <fstream>
#include <numbers>
#include <regex>
#include <string>

#include "daemon/config/yaml_section.h"
#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

class ConfigFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const std::filesystem::path file = directory_ / "stereod.yaml";
    std::ofstream(file) << text;
    return file;
  }
  Config read(const std::string& text) { return read_config(write(text)); }

  /// The error, without the directory's name before the file's.
  std::string error_of(const std::string& text) {
    const std::string sentence = file_error_of([&] { read(text); });
    const std::string directory = directory_.path().string() + "/";
    return sentence.rfind(directory, 0) == 0 ? sentence.substr(directory.size()) : sentence;
  }

  TemporaryDirectory directory_;
};

TEST_F(ConfigFile, TheLeastThatIsNeededGivesTheDefaults) {
  const Config config = read("cameras:\n  source: synthetic\n");
  EXPECT_EQ(config.cameras.source, SourceKind::kSynthetic);
  EXPECT_EQ(config.cameras.fps, 30);
  EXPECT_EQ(config.matcher.disparities, 64);
  EXPECT_EQ(config.matcher.uniqueness_ratio, matcher_preset("robust")->uniqueness_ratio);
  EXPECT_EQ(config.lcm.prefix, "STEREO");
  EXPECT_GE(config.worker_count(), 1);
}

TEST_F(ConfigFile, EveryKeyOfTheSemiglobalMatcherIsRead) {
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

TEST_F(ConfigFile, EveryKeyIsRead) {
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
  ground: given
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

TEST_F(ConfigFile, EveryKeyOfTheCamerasIsRead) {
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

TEST_F(ConfigFile, ToleranceIsHalfAFrameUnlessSet) {
  EXPECT_EQ(read("cameras: {source: synthetic, fps: 50}").cameras.pairing_tolerance_ns(), 10'000'000);
}

struct BadConfig {
  const char* text;
  const char* error;
};

class BadConfigFile : public ConfigFile, public testing::WithParamInterface<BadConfig> {};

TEST_P(BadConfigFile, IsToldInOneSentence) { EXPECT_EQ(error_of(GetParam().text), GetParam().error); }

INSTANTIATE_TEST_SUITE_P(
    Config, BadConfigFile,
    testing::Values(
        BadConfig{"matcher: {}\n", "stereod.yaml: cameras: is missing"},
        BadConfig{
            "cameras: {source: synthetic}\nscan: {min_obstacle_height_m: 0.5, max_obstacle_height_m: 0.5}\n",
            "stereod.yaml:2: scan.max_obstacle_height_m: is not above min_obstacle_height_m, so that nothing would be an obstacle"},
        BadConfig{"cameras: {source: log}\n",
                  "stereod.yaml: cameras.log.file: found nothing, needed is the name of an LCM log"},
        BadConfig{"cameras: {source: synthetic}\nlcm: {left_image: png}\n",
                  "stereod.yaml:2: lcm.left_image: found 'png', allowed are off, jpeg and gray"},
        BadConfig{
            "cameras: {source: synthetic}\npublish: {cloud_decimation: 65}\n",
            "stereod.yaml:2: publish.cloud_decimation: found '65', allowed are whole numbers from 1 to 64"},
        BadConfig{"cameras: {source: synthetic}\npublish: {depth: mm}\n",
                  "stereod.yaml:2: publish.depth: found 'mm', allowed are true and false"},
        BadConfig{"cameras: {source: synthetic}\npublish: {decimation_y: 0}\n",
                  "stereod.yaml:2: publish.decimation_y: found '0', allowed are whole numbers from 1 to 64"},
        BadConfig{
            "cameras: {source: synthetic}\npublish: {region: {left: -1}}\n",
            "stereod.yaml:2: publish.region.left: found '-1', allowed are whole numbers from 0 to 4096"},
        BadConfig{
            "cameras: {source: synthetic}\npublish: {region: {right: 3}}\n",
            "stereod.yaml:2: publish.region.right: is not a known key; the nearest known key is 'height'"},
        BadConfig{"cameras: {source: synthetic}\nscan: {ground: guess}\n",
                  "stereod.yaml:2: scan.ground: found 'guess', allowed are fit and given"},
        BadConfig{"cameras:\nlcm: {}\n", "stereod.yaml:1: cameras.source: is missing"},
        BadConfig{"cameras:\n  fps: 3\n", "stereod.yaml:2: cameras.source: is missing"},
        BadConfig{
            "cameras:\n  source: webcam\n",
            "stereod.yaml:2: cameras.source: found 'webcam', allowed are v4l2, replay, synthetic and log"},
        BadConfig{"cameras:\n  source: synthetic\n  speed: 3\n",
                  "stereod.yaml:3: cameras.speed: is not a known key; the nearest known key is 'fps'"},
        BadConfig{"cameras:\n  source: synthetic\nmatcher:\n  dispariites: 64\n",
                  "stereod.yaml:4: matcher.dispariites: is not a known key; the nearest known key is "
                  "'disparities'"},
        BadConfig{"cameras: {source: synthetic}\nmatchr: {}\n",
                  "stereod.yaml:2: matchr: is not a known key; the nearest known key is 'matcher'"},
        BadConfig{
            "cameras: {source: synthetic}\nmatcher:\n  disparities: 300\n",
            "stereod.yaml:3: matcher.disparities: found '300', allowed are whole numbers from 1 to 256"},
        BadConfig{
            "cameras: {source: synthetic}\nmatcher:\n  disparities: many\n",
            "stereod.yaml:3: matcher.disparities: found 'many', allowed are whole numbers from 1 to 256"},
        BadConfig{
            "cameras: {source: synthetic}\nmatcher:\n  disparities: 6.5\n",
            "stereod.yaml:3: matcher.disparities: found '6.5', allowed are whole numbers from 1 to 256"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  disparities: [1, 2]\n",
                  "stereod.yaml:3: matcher.disparities: found a list, allowed is one value"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  preset: fast\n  window: 10\n",
                  "stereod.yaml:4: matcher.window: found 10, allowed are odd numbers from 3 to 31"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  preset: fast\n  median: 4\n",
                  "stereod.yaml:4: matcher.median: median is 4, allowed are 0 (off), 3 and 5"},
        BadConfig{
            "cameras: {source: synthetic}\nmatcher:\n  preset: quick\n",
            "stereod.yaml:3: matcher.preset: found 'quick', allowed are thesis, fast, robust, dense, fine"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  window: 9\n",
                  "stereod.yaml:3: matcher.window: belongs to method: block, which is not the one chosen"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  preset: fast\n  p2: 9\n",
                  "stereod.yaml:4: matcher.p2: belongs to method: semiglobal, which is not the one chosen"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  method: census\n",
                  "stereod.yaml:3: matcher.method: found 'census', allowed are block and semiglobal"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  p1: 256\n",
                  "stereod.yaml:3: matcher.p1: found '256', allowed are whole numbers from 0 to 255"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  median: 5\n",
                  "stereod.yaml:3: matcher.median: median is 5 but method is semiglobal; it has a median of "
                  "3 or none (0)"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  subpixel: maybe\n",
                  "stereod.yaml:3: matcher.subpixel: found 'maybe', allowed are true and false"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {left: //dev/video0, right: /dev/./video0}\n",
                  "stereod.yaml:3: cameras.v4l2.right: found '/dev/video0', which is the left camera; name "
                  "another one"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {exposure: follow, controls: {auto_exposure: 3}}\n",
                  "stereod.yaml:3: cameras.v4l2.controls: found auto_exposure: 3, an automatic mode, but "
                  "'exposure: "
                  "follow' sets it by itself; leave it out, or set 'exposure: auto'"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {exposure: lock, left_controls: {gain: 3}}\n",
            "stereod.yaml:3: cameras.v4l2.left_controls: found gain for one camera, but with 'exposure: "
            "lock' both have the same; name it in 'controls' for both, or set 'exposure: auto'"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {exposure: follow, right_controls: {exposure_absolute: 3}}\n",
            "stereod.yaml:3: cameras.v4l2.right_controls: found exposure_absolute for one camera, but "
            "with 'exposure: follow' both have the same; name it in 'controls' for both, or set "
            "'exposure: auto'"},
        BadConfig{"cameras: {source: synthetic}\nmatcher: 7\n",
                  "stereod.yaml:2: matcher: found '7', allowed is a map of keys and values"},
        BadConfig{"cameras: {source: synthetic}\nworkers: 3\nworkers: 4\n",
                  "stereod.yaml:3: workers: stands here a second time; keep one of them"},
        BadConfig{"cameras: {source: synthetic}\nscheduling:\n  priority: 100\n",
                  "stereod.yaml:3: scheduling.priority: found '100', allowed are whole numbers from 0 to 99"},
        BadConfig{
            "cameras: {source: synthetic}\nscheduling:\n  cpus: 0,3-2\n",
            "stereod.yaml:3: scheduling.cpus: found '0,3-2', allowed are lists of CPUs by number from 0 to "
            "1023, such as 2-3 or 0,2-3"},
        BadConfig{
            "cameras: {source: synthetic}\nlcm:\n  prefix: 'A B'\n",
            "stereod.yaml:3: lcm.prefix: found 'A B', allowed are 1 to 40 letters, digits, '_', '-' and '.'"},
        BadConfig{"cameras: {source: synthetic}\nlog:\n  level: loud\n",
                  "stereod.yaml:3: log.level: found 'loud', allowed are debug, info, warning and error"},
        BadConfig{"cameras:\n  source: replay\n",
                  "stereod.yaml: cameras.replay.left: found nothing to play, allowed are either left and "
                  "right, two "
                  "images, or directory, one with numbered pairs"},
        BadConfig{
            "cameras:\n  source: replay\n  replay: {left: a.png}\n",
            "stereod.yaml:3: cameras.replay.left: found one of left and right, allowed are either left and "
            "right, two images, or directory, one with numbered pairs"},
        BadConfig{"cameras: {source: synthetic, synthetic: {scene: bord}}\n",
                  "stereod.yaml:1: cameras.synthetic.scene: found 'bord', allowed are room and board"},
        BadConfig{"cameras: {source: synthetic, fps: -1}\n",
                  "stereod.yaml:1: cameras.fps: found '-1', allowed are numbers from 0 to 240"},
        BadConfig{"cameras: {source: synthetic, fps: .nan}\n",
                  "stereod.yaml:1: cameras.fps: found '.nan', allowed are numbers from 0 to 240"},
        BadConfig{"cameras: {source: v4l2, fps: 0.5}\n",
                  "stereod.yaml:1: cameras.fps: found a rate below 1, allowed for cameras are 1 to 240"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {left: /dev/video0, right: /dev/video0}\n",
                  "stereod.yaml:3: cameras.v4l2.right: found '/dev/video0', which is the left camera; name "
                  "another one"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {left: /dev/video0}\n",
                  "stereod.yaml: cameras.v4l2.right: found 'auto' for one camera only, allowed is auto for "
                  "both or a name for each"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {left: ''}\n",
                  "stereod.yaml:3: cameras.v4l2.left: found '', allowed are auto, a name below "
                  "/dev/v4l/by-path or by-id, a node such as /dev/video0, and serial:NUMBER; 'stereod "
                  "--list-cameras' shows them"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {format: rgb}\n",
                  "stereod.yaml:3: cameras.v4l2.format: found 'rgb', allowed are auto, gray, nv12, yu12, "
                  "yuyv, uyvy, y10, y16 and mjpeg"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {exposure: manual}\n",
                  "stereod.yaml:3: cameras.v4l2.exposure: found 'manual', allowed are auto, lock and follow"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2:\n    controls: {gain: high}\n",
                  "stereod.yaml:4: cameras.v4l2.controls.gain: found 'high', allowed are whole numbers from "
                  "-2147483648 to 2147483647"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2:\n    controls: [gain]\n",
                  "stereod.yaml:4: cameras.v4l2.controls: found a list, allowed is a map of keys and values"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {align: maybe}\n",
                  "stereod.yaml:3: cameras.v4l2.sync: found 'maybe', allowed are never, start and always"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {widh: 3}\n",
                  "stereod.yaml:3: cameras.v4l2.widh: is not a known key; the nearest known key is 'width'"},
        BadConfig{"cameras: {source: synthetic}\nrectify: {interpolation: cubic}\n",
                  "stereod.yaml:2: rectify.interpolation: found 'cubic', allowed are nearest and bilinear"},
        BadConfig{"cameras: {source: synthetic}\nrectify: {alpha: 1.5}\n",
                  "stereod.yaml:2: rectify.alpha: found '1.5', allowed are numbers from 0 to 1"},
        BadConfig{"cameras: {source: synthetic}\nlcm:\n  raw_images_per_second: 0\n",
                  "stereod.yaml:3: lcm.raw_images_per_second: found '0', allowed are numbers from 0.1 to 60"},
        BadConfig{"cameras: {source: synthetic\n",
                  "stereod.yaml:2: not valid YAML: end of map flow not found"},
        BadConfig{"- a\n- b\n", "stereod.yaml:1: expected a map of keys and values, found a list"},
        BadConfig{"", "stereod.yaml:1: expected a map of keys and values, found nothing"}));

TEST_F(ConfigFile, MissingFileAndFolderAreToldApart) {
  EXPECT_EQ(file_error_of([] { read_config("/nowhere/stereod.yaml"); }),
            "/nowhere/stereod.yaml: the file does not exist");
  EXPECT_EQ(file_error_of([&] { read_config(directory_.path()); }),
            directory_.path().string() + ": is a directory; a file is needed");
}

// Any reason but that there is none would do; a link to itself is one that root cannot pass either.
TEST_F(ConfigFile, FileOutOfReachIsNotCalledMissing) {
  const std::filesystem::path link = directory_.path() / "link.yaml";
  std::filesystem::create_symlink("link.yaml", link);
  EXPECT_EQ(file_error_of([&] { read_config(link); }).find(link.string() + ": cannot be reached ("), 0U);
}

// The values written in the comments of etc/stereod.yaml are the defaults: uncommented, they change nothing.
TEST_F(ConfigFile, TheShippedFileSaysTheDefaults) {
  std::ifstream in(std::string(STEREOD_SOURCE_DIR) + "/etc/stereod.yaml");
  std::string uncommented;
  std::string block_keys;
  int matcher_keys = 0;
  for (std::string line; std::getline(in, line);) {
    static const std::regex kCommentedKey("  # ([a-z_]+: [a-z0-9-]+)");
    std::smatch match;
    if (std::regex_match(line, match, kCommentedKey)) {
      line = "  " + match[1].str();
      ++matcher_keys;
    }
    static const std::regex kBlockKey("  # ([a-z_]+: [a-z0-9-]+)  # block");
    if (std::regex_match(line, match, kBlockKey)) block_keys += "  " + match[1].str() + "\n";
    uncommented += line + "\n";
  }
  EXPECT_EQ(matcher_keys, 15);
  EXPECT_EQ(std::count(block_keys.begin(), block_keys.end(), '\n'), 4);
  EXPECT_EQ(read("cameras: {source: synthetic}\nmatcher:\n  preset: fast\n" + block_keys).matcher,
            matcher_preset("fast"));
  const Config defaults;
  const Config shipped = read(uncommented);
  EXPECT_EQ(shipped.cameras.fps, defaults.cameras.fps);
  EXPECT_EQ(shipped.cameras.width, defaults.cameras.width);
  EXPECT_EQ(shipped.cameras.height, defaults.cameras.height);
  EXPECT_EQ(shipped.cameras.source, SourceKind::kV4l2);
  EXPECT_EQ(shipped.cameras.v4l2.left, defaults.cameras.v4l2.left);
  EXPECT_EQ(shipped.cameras.v4l2.right, defaults.cameras.v4l2.right);
  EXPECT_EQ(shipped.cameras.v4l2.width, defaults.cameras.v4l2.width);
  EXPECT_EQ(shipped.cameras.v4l2.height, defaults.cameras.v4l2.height);
  EXPECT_EQ(shipped.cameras.v4l2.format, defaults.cameras.v4l2.format);
  EXPECT_EQ(shipped.cameras.v4l2.exposure, defaults.cameras.v4l2.exposure);
  EXPECT_TRUE(shipped.cameras.v4l2.controls.empty());
  EXPECT_EQ(shipped.cameras.v4l2.sync, defaults.cameras.v4l2.sync);
  EXPECT_EQ(shipped.cameras.v4l2.max_sync_skew_ms, defaults.cameras.v4l2.max_sync_skew_ms);
  EXPECT_EQ(shipped.cameras.v4l2.sync_attempts, defaults.cameras.v4l2.sync_attempts);
  EXPECT_EQ(shipped.lcm.raw_images, defaults.lcm.raw_images);
  EXPECT_EQ(shipped.lcm.raw_images_per_second, defaults.lcm.raw_images_per_second);
  EXPECT_EQ(shipped.rectify.interpolation, defaults.rectify.interpolation);
  EXPECT_EQ(shipped.rectify.alpha, defaults.rectify.alpha);
  EXPECT_EQ(shipped.matcher, defaults.matcher);
  EXPECT_EQ(shipped.lcm.url, defaults.lcm.url);
  EXPECT_EQ(shipped.lcm.prefix, defaults.lcm.prefix);
  EXPECT_EQ(shipped.lcm.rows_per_message, defaults.lcm.rows_per_message);
  EXPECT_EQ(shipped.lcm.pacing, defaults.lcm.pacing);
  EXPECT_EQ(shipped.workers, defaults.workers);
  EXPECT_EQ(shipped.scheduling.priority, defaults.scheduling.priority);
  EXPECT_TRUE(shipped.scheduling.cpus.empty());
  EXPECT_EQ(shipped.log_level, defaults.log_level);
}

TEST_F(ConfigFile, TheDemoFileIsFine) {
  EXPECT_NO_THROW(read_config(std::string(STEREOD_SOURCE_DIR) + "/etc/demo.yaml"));
}

TEST(EditDistance, CountsSingleChanges) {
  EXPECT_EQ(edit_distance("window", "window"), 0u);
  EXPECT_EQ(edit_distance("windw", "window"), 1u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

}  // namespace
}  // namespace stereod
