// SPDX-License-Identifier: BSD-3-Clause
// Tests the messages about mistakes in stereod.yaml.
#include "tests/daemon/config/config_file.h"

#include <sstream>
#include <string>

#include "daemon/config/reference.h"
#include "daemon/config/renamed_keys.h"

namespace stereod {
namespace {

struct BadConfig {
  const char* text;
  const char* error;
};

class BadConfigFile : public ConfigFile, public testing::WithParamInterface<BadConfig> {};

TEST_P(BadConfigFile, Mistake_NamedInOneSentence) { EXPECT_EQ(error_of(GetParam().text), GetParam().error); }

INSTANTIATE_TEST_SUITE_P(
    Config, BadConfigFile,
    testing::Values(
        BadConfig{"matcher: {}\n", "stereod.yaml: cameras: is missing"},
        BadConfig{
            "cameras: {source: synthetic}\nscan: {min_obstacle_height_m: 0.5, max_obstacle_height_m: 0.5}\n",
            "stereod.yaml:2: scan.max_obstacle_height_m: found 0.5, allowed more than min_obstacle_height_m (0.5)"},
        BadConfig{"cameras: {source: log}\n",
                  "stereod.yaml: cameras.log.file: found nothing, allowed the name of an LCM log"},
        BadConfig{"cameras: {source: synthetic}\nlcm: {left_image: png}\n",
                  "stereod.yaml:2: lcm.left_image: found 'png', allowed none, jpeg, gray"},
        BadConfig{"cameras: {source: synthetic}\npublish: {cloud_decimation: 65}\n",
                  "stereod.yaml:2: publish.cloud_decimation: found 65, allowed 1…64"},
        BadConfig{"cameras: {source: synthetic}\npublish: {depth: mm}\n",
                  "stereod.yaml:2: publish.depth: found 'mm', allowed true, false"},
        BadConfig{"cameras: {source: synthetic}\npublish: {decimation_y: 0}\n",
                  "stereod.yaml:2: publish.decimation_y: found 0, allowed 1…64"},
        BadConfig{"cameras: {source: synthetic}\npublish: {region: {left: -1}}\n",
                  "stereod.yaml:2: publish.region.left: found -1, allowed 0…4096"},
        BadConfig{
            "cameras: {source: synthetic}\npublish: {region: {right: 3}}\n",
            "stereod.yaml:2: publish.region.right: is not a known key; the nearest known key is 'height'"},
        BadConfig{"cameras: {source: synthetic}\nscan: {ground: guess}\n",
                  "stereod.yaml:2: scan.ground: found 'guess', allowed estimate, fixed"},
        BadConfig{"cameras:\nlcm: {}\n", "stereod.yaml:1: cameras.source: is missing"},
        BadConfig{"cameras:\n  fps: 3\n", "stereod.yaml:2: cameras.source: is missing"},
        BadConfig{"cameras:\n  source: webcam\n",
                  "stereod.yaml:2: cameras.source: found 'webcam', allowed v4l2, replay, synthetic, log"},
        BadConfig{"cameras:\n  source: synthetic\n  speed: 3\n",
                  "stereod.yaml:3: cameras.speed: is not a known key; the nearest known key is 'fps'"},
        BadConfig{
            "cameras:\n  source: synthetic\nmatcher:\n  dispariites: 64\n",
            "stereod.yaml:4: matcher.dispariites: is not a known key; the nearest known key is 'disparities'"},
        BadConfig{"cameras: {source: synthetic}\nmatchr: {}\n",
                  "stereod.yaml:2: matchr: is not a known key; the nearest known key is 'matcher'"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  disparities: 300\n",
                  "stereod.yaml:3: matcher.disparities: found 300, allowed 1…256"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  disparities: many\n",
                  "stereod.yaml:3: matcher.disparities: found 'many', allowed 1…256 (whole numbers)"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  disparities: 6.5\n",
                  "stereod.yaml:3: matcher.disparities: found 6.5, allowed 1…256 (whole numbers)"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  disparities: [1, 2]\n",
                  "stereod.yaml:3: matcher.disparities: found a list, allowed one value"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  preset: fast\n  window: 10\n",
                  "stereod.yaml:4: matcher.window: found 10, allowed 3…31, odd"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  preset: fast\n  median: 4\n",
                  "stereod.yaml:4: matcher.median: found 4, allowed 0, 3, 5"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  preset: quick\n",
                  "stereod.yaml:3: matcher.preset: found 'quick', allowed robust, dense, fine, fast, thesis"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  window: 9\n",
                  "stereod.yaml:3: matcher.window: belongs to method: block, but the method is semiglobal"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  preset: fast\n  p2: 9\n",
                  "stereod.yaml:4: matcher.p2: belongs to method: semiglobal, but the method is block"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  method: census\n",
                  "stereod.yaml:3: matcher.method: found 'census', allowed block, semiglobal"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  p1: 256\n",
                  "stereod.yaml:3: matcher.p1: found 256, allowed 0…255"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  median: 5\n",
                  "stereod.yaml:3: matcher.median: found 5 with method semiglobal, allowed 0, 3"},
        BadConfig{"cameras: {source: synthetic}\nmatcher:\n  subpixel: maybe\n",
                  "stereod.yaml:3: matcher.subpixel: found 'maybe', allowed true, false"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {left: //dev/video0, right: /dev/./video0}\n",
            "stereod.yaml:3: cameras.v4l2.right: found '/dev/video0', which is the left camera, allowed another one"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {exposure: follow, controls: {auto_exposure: 3}}\n",
            "stereod.yaml:3: cameras.v4l2.controls: found auto_exposure: 3, an automatic mode, but 'exposure: follow' sets it; remove it, or set 'exposure: auto'"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {exposure: lock, left_controls: {gain: 3}}\n",
            "stereod.yaml:3: cameras.v4l2.left_controls: found gain for one camera, but 'exposure: lock' makes it equal for both; name it in 'controls', or set 'exposure: auto'"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {exposure: follow, right_controls: {exposure_absolute: 3}}\n",
            "stereod.yaml:3: cameras.v4l2.right_controls: found exposure_absolute for one camera, but 'exposure: follow' makes it equal for both; name it in 'controls', or set 'exposure: auto'"},
        BadConfig{"cameras: {source: synthetic}\nmatcher: 7\n",
                  "stereod.yaml:2: matcher: found '7', allowed a map of keys and values"},
        BadConfig{"cameras: {source: synthetic}\nworkers: 3\nworkers: 4\n",
                  "stereod.yaml:3: workers: is given twice; remove one of them"},
        BadConfig{"cameras: {source: synthetic}\nscheduling:\n  priority: 100\n",
                  "stereod.yaml:3: scheduling.priority: found 100, allowed 0…99"},
        BadConfig{
            "cameras: {source: synthetic}\nscheduling:\n  cpus: 0,3-2\n",
            "stereod.yaml:3: scheduling.cpus: found '0,3-2', allowed CPU numbers 0…1023, such as 2-3 or 0,2-3"},
        BadConfig{"cameras: {source: synthetic}\nlcm:\n  prefix: 'A B'\n",
                  "stereod.yaml:3: lcm.prefix: found 'A B', allowed 1…40 letters, digits, '_', '-', '.'"},
        BadConfig{"cameras: {source: synthetic}\nlog:\n  level: loud\n",
                  "stereod.yaml:3: log.level: found 'loud', allowed debug, info, warning, error"},
        BadConfig{
            "cameras:\n  source: replay\n",
            "stereod.yaml: cameras.replay.left: found nothing to play, allowed two images, left and right, or a directory of numbered pairs"},
        BadConfig{
            "cameras:\n  source: replay\n  replay: {left: a.png}\n",
            "stereod.yaml:3: cameras.replay.left: found one of left and right, allowed two images, left and right, or a directory of numbered pairs"},
        BadConfig{"cameras: {source: synthetic, synthetic: {scene: bord}}\n",
                  "stereod.yaml:1: cameras.synthetic.scene: found 'bord', allowed room, board"},
        BadConfig{"cameras: {source: synthetic, fps: -1}\n",
                  "stereod.yaml:1: cameras.fps: found -1, allowed 0…240"},
        BadConfig{"cameras: {source: synthetic, fps: .nan}\n",
                  "stereod.yaml:1: cameras.fps: found '.nan', allowed 0…240"},
        BadConfig{"cameras: {source: v4l2, fps: 0.5}\n",
                  "stereod.yaml:1: cameras.fps: found 0.5, allowed for source v4l2 1…240"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {left: /dev/video0, right: /dev/video0}\n",
            "stereod.yaml:3: cameras.v4l2.right: found '/dev/video0', which is the left camera, allowed another one"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {left: /dev/video0}\n",
            "stereod.yaml: cameras.v4l2.right: found 'auto' for one camera, allowed auto for both cameras or a name for each"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {left: ''}\n",
            "stereod.yaml:3: cameras.v4l2.left: found '', allowed auto, /dev/v4l/by-path/…, /dev/v4l/by-id/…, serial:NUMBER, /dev/videoN; 'stereod --list-cameras' prints the names"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2: {format: rgb}\n",
            "stereod.yaml:3: cameras.v4l2.format: found 'rgb', allowed auto, gray, nv12, yu12, yuyv, uyvy, y10, y16, mjpeg"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {exposure: manual}\n",
                  "stereod.yaml:3: cameras.v4l2.exposure: found 'manual', allowed auto, follow, lock"},
        BadConfig{
            "cameras:\n  source: v4l2\n  v4l2:\n    controls: {gain: high}\n",
            "stereod.yaml:4: cameras.v4l2.controls.gain: found 'high', allowed -2147483648…2147483647 (whole numbers)"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2:\n    controls: [gain]\n",
                  "stereod.yaml:4: cameras.v4l2.controls: found a list, allowed a map of keys and values"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {sync: maybe}\n",
                  "stereod.yaml:3: cameras.v4l2.sync: found 'maybe', allowed none, start, always"},
        BadConfig{"cameras:\n  source: v4l2\n  v4l2: {widh: 3}\n",
                  "stereod.yaml:3: cameras.v4l2.widh: is not a known key; the nearest known key is 'width'"},
        BadConfig{"cameras: {source: synthetic}\nrectify: {interpolation: cubic}\n",
                  "stereod.yaml:2: rectify.interpolation: found 'cubic', allowed bilinear, nearest"},
        BadConfig{"cameras: {source: synthetic}\nrectify: {alpha: 1.5}\n",
                  "stereod.yaml:2: rectify.alpha: found 1.5, allowed 0…1"},
        BadConfig{"cameras: {source: synthetic}\nlcm:\n  raw_images_per_second: 0\n",
                  "stereod.yaml:3: lcm.raw_images_per_second: found 0, allowed 0.1…60"},
        BadConfig{"cameras: {source: synthetic\n",
                  "stereod.yaml:2: not valid YAML: end of map flow not found"},
        BadConfig{"- a\n- b\n", "stereod.yaml:1: found a list, allowed a map of keys and values"},
        BadConfig{"", "stereod.yaml:1: found nothing, allowed a map of keys and values"}));

TEST_F(ConfigFile, RenamedKey_IsRefusedWithItsNewName) {
  for (const RenamedKey& renamed : renamed_keys()) {
    std::string text, indent;
    std::istringstream words{std::string(renamed.old_key)};
    for (std::string word; std::getline(words, word, '.'); indent += "  ") {
      text += (text.empty() ? "" : "\n") + indent + word + ":";
      if (word == "cameras") text += "\n  source: synthetic";
      if (word == "replay") text += "\n    directory: d";
    }
    if (!text.starts_with("cameras:")) text = "cameras: {source: synthetic}\n" + text;
    const std::string error = error_of(text + " 1\n");
    const std::string expected = ": " + std::string(renamed.old_key) + ": is not a known key; it is now '" +
                                 std::string(renamed.new_key) + "'";
    EXPECT_TRUE(error.ends_with(expected)) << error;
    EXPECT_NE(
        reference_yaml().find(std::string(renamed.new_key.substr(renamed.new_key.rfind('.') + 1)) + ": "),
        std::string::npos)
        << renamed.new_key;
  }
}

TEST_F(ConfigFile, RenamedValue_IsRefusedWithItsNewName) {
  for (const RenamedValue& renamed : renamed_values()) {
    const std::string old_value(renamed.old_value), key(renamed.key);
    const std::string last = key.substr(key.rfind('.') + 1);
    std::string text = "cameras: {source: synthetic}\n" + key.substr(0, key.find('.')) + ": {" + last + ": " +
                       old_value + "}\n";
    if (key.starts_with("cameras.")) {
      text = "cameras: {source: synthetic, v4l2: {" + last + ": " + old_value + "}}\n";
    }
    const std::string error = error_of(text);
    EXPECT_NE(error.find(key + ": found '" + old_value + "', allowed "), std::string::npos) << error;
    EXPECT_TRUE(error.ends_with("; '" + old_value + "' is now '" + std::string(renamed.new_value) + "'"))
        << error;
  }
}

}  // namespace
}  // namespace stereod
