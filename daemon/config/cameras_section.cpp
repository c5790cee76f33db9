// SPDX-License-Identifier: BSD-3-Clause
// Reads the section `cameras` except `v4l2`.
#include <array>
#include <string>
#include <utility>

#include "core/base/enum_names.h"
#include "daemon/config/sections.h"

namespace stereod {
namespace {

constexpr EnumNames<SourceKind, 4> kSourceNames{{{SourceKind::kV4l2, "v4l2"},
                                                 {SourceKind::kReplay, "replay"},
                                                 {SourceKind::kSynthetic, "synthetic"},
                                                 {SourceKind::kLog, "log"}}};
constexpr EnumNames<SceneKind, 2> kSceneNames{{{SceneKind::kRoom, "room"}, {SceneKind::kBoard, "board"}}};

constexpr std::string_view kImageFile = "PNG, JPEG, PGM or PPM file";

void read_replay(YamlSection section, CamerasConfig& cameras) {
  section.read(replay_options(), cameras);
  section.finish();
  const bool pair = !cameras.replay_left.empty() && !cameras.replay_right.empty();
  const bool half = cameras.replay_left.empty() != cameras.replay_right.empty();
  if (half || pair != cameras.replay_directory.empty()) {
    section.fail("left", "found " +
                             std::string(half   ? "one of left and right"
                                         : pair ? "both a pair and a directory"
                                                : "nothing to play") +
                             ", allowed two images, left and right, or a directory of numbered pairs");
  }
}

void read_log_source(YamlSection section, CamerasConfig& cameras) {
  section.read(log_source_options(), cameras);
  section.finish();
  if (cameras.log_file.empty()) section.fail("file", "found nothing, allowed the name of an LCM log");
}

}  // namespace

const Options<CamerasConfig>& cameras_options() {
  using C = CamerasConfig;
  static const Options<C> table{
      choice<kSourceNames, &C::source>(
          {.key = "source",
           .required = true,
           .example = "v4l2",
           .description =
               "Origin of the frames. v4l2: two cameras. replay: recorded images. synthetic: a rendered scene of known depth. log: raw images in an LCM log."}),
      option<&C::fps>(
          {.key = "fps",
           .unit = "Hz",
           .minimum = 0,
           .maximum = 240,
           .description =
               "Frame rate, at least 1 for source v4l2. 0: stereod processes every frame when the previous frame is "
               "sent, and drops no frame."}),
      option<&C::max_skew_ms>(
          {.key = "max_skew_ms",
           .unit = "ms",
           .minimum = 0,
           .maximum = 1000,
           .default_name = "half a frame period",
           .description = "Maximum time between the left and the right frame of a pair."}),
  };
  return table;
}

const Options<CamerasConfig>& replay_options() {
  using C = CamerasConfig;
  static const Options<C> table{
      option<&C::replay_left>({.key = "left",
                               .format = kImageFile,
                               .example = "left.png",
                               .description = "Left image, relative to the directory of this file."}),
      option<&C::replay_right>(
          {.key = "right", .format = kImageFile, .example = "right.png", .description = "Right image."}),
      option<&C::replay_directory>(
          {.key = "directory",
           .format = "directory",
           .example = "recording",
           .description =
               "Directory of numbered pairs, instead of left and right. The names are left_00.png and "
               "right_00.png, or left/00.png and right/00.png, and so on."}),
      option<&C::replay_loop>(
          {.key = "loop",
           .description = "After the last pair: stereod starts again (true) or exits (false)."}),
  };
  return table;
}

const Options<CamerasConfig>& log_source_options() {
  using C = CamerasConfig;
  static const Options<C> table{
      option<&C::log_file>(
          {.key = "file",
           .format = "LCM log",
           .example = "field.lcm",
           .description =
               "Log with raw images, written by lcm-logger or 'stereo-tap record' while lcm.raw_images was true. "
               "Frames keep the timestamps of the log. With cameras.fps: 0 stereod plays the log as fast as it can "
               "match; with any other value it plays at the recorded speed."}),
      option<&C::log_prefix>({.key = "prefix",
                              .format = "text",
                              .description = "First part of the names of the channels in the log."}),
      option<&C::log_loop>(
          {.key = "loop",
           .description = "After the last pair: stereod starts again (true) or exits (false)."}),
  };
  return table;
}

const Options<CamerasConfig>& synthetic_options() {
  using C = CamerasConfig;
  static const Options<C> table{
      choice<kSceneNames, &C::scene>(
          {.key = "scene",
           .description =
               "Rendered scene. room: boxes that stand and move. board: a chessboard of 9×6 inner corners and "
               "25 mm squares that moves in front of the cameras, to practice 'stereo-calibrate capture'."}),
      option<&C::width>({.key = "width",
                         .unit = "px",
                         .minimum = 64,
                         .maximum = 1920,
                         .description = "Width of the rendered images."}),
      option<&C::height>({.key = "height",
                          .unit = "px",
                          .minimum = 48,
                          .maximum = 1200,
                          .description = "Height of the rendered images."}),
      option<&C::skew_ms>({.key = "skew_ms",
                           .unit = "ms",
                           .minimum = -100,
                           .maximum = 100,
                           .description = "Delay of the right camera's exposure relative to the left one."}),
  };
  return table;
}

void read_cameras_section(YamlSection section, CamerasConfig& cameras) {
  section.required_text("source");
  section.read(cameras_options(), cameras);
  // A section of a source that is not selected may stay in the file. It is checked all the same.
  read_v4l2_section(section, cameras);
  YamlSection replay = section.section("replay");
  YamlSection synthetic = section.section("synthetic");
  YamlSection log = section.section("log");
  if (cameras.source == SourceKind::kReplay || section.has("replay")) read_replay(std::move(replay), cameras);
  if (cameras.source == SourceKind::kLog || section.has("log")) read_log_source(std::move(log), cameras);
  synthetic.read(synthetic_options(), cameras);
  synthetic.finish();
  section.finish();
}

std::string_view name_of(SourceKind kind) { return find_name(kSourceNames, kind); }

}  // namespace stereod
