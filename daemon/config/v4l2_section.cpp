// SPDX-License-Identifier: BSD-3-Clause
// Reads the section `cameras.v4l2`.
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include "core/base/limits.h"
#include "core/base/text.h"
#include "daemon/config/sections.h"

namespace stereod {
namespace {

constexpr EnumNames<ExposureMode, 3> kExposureNames{
    {{ExposureMode::kAuto, "auto"}, {ExposureMode::kFollow, "follow"}, {ExposureMode::kLock, "lock"}}};
constexpr EnumNames<SyncMode, 3> kSyncNames{
    {{SyncMode::kNone, "none"}, {SyncMode::kStart, "start"}, {SyncMode::kAlways, "always"}}};

constexpr std::string_view kDevice =
    "auto, /dev/v4l/by-path/…, /dev/v4l/by-id/…, serial:NUMBER, /dev/videoN; 'stereod --list-cameras' prints the names";
constexpr std::string_view kControls = "NAME: VALUE, …";

bool is_device(std::string_view text) { return !text.empty() && text != "serial:"; }

/// Returns one spelling for all spellings of a node, such as //dev/video0.
std::string normalized(const std::string& device) {
  return device.starts_with('/') ? std::filesystem::path(device).lexically_normal().string() : device;
}

std::string exposure_setting(ExposureMode mode) {
  return "'exposure: " + std::string(find_name(kExposureNames, mode)) + "'";
}

void check_devices(YamlSection& section, V4l2Config& v4l2) {
  v4l2.left = normalized(v4l2.left);
  v4l2.right = normalized(v4l2.right);
  if (v4l2.left == v4l2.right && v4l2.left != "auto") {
    section.fail("right", "found '" + v4l2.right + "', which is the left camera, allowed another one");
  }
  if ((v4l2.left == "auto") != (v4l2.right == "auto")) {
    section.fail(v4l2.left == "auto" ? "left" : "right",
                 "found 'auto' for one camera, allowed auto for both cameras or a name for each");
  }
}

/// Refuses a control for one camera alone that lock and follow make equal for both.
void check_own_controls(YamlSection& section, const std::string& key, const ControlValues& own,
                        ExposureMode mode) {
  constexpr std::array<std::string_view, 7> kExposure{
      "exposure_time_absolute", "exposure_absolute", "auto_exposure", "exposure_auto", "gain",
      "gain_automatic",         "autogain"};
  if (mode == ExposureMode::kAuto) return;
  for (const auto& [name, value] : own) {
    if (std::find(kExposure.begin(), kExposure.end(), name) == kExposure.end()) continue;
    section.fail(key, "found " + name + " for one camera, but " + exposure_setting(mode) +
                          " makes it equal for both; name it in 'controls', or set 'exposure: auto'");
  }
}

/// Refuses automatic modes that lock and follow switch themselves.
void check_modes(YamlSection& section, const ControlValues& values, ExposureMode mode) {
  if (mode == ExposureMode::kAuto) return;
  for (const auto& [name, value] : values) {
    const bool exposure = name == "auto_exposure" || name == "exposure_auto";
    const bool gain = name == "gain_automatic" || name == "autogain";
    if (!(exposure && value != 1) && !(gain && value != 0)) continue;
    section.fail("controls", "found " + name + ": " + std::to_string(value) + ", an automatic mode, but " +
                                 exposure_setting(mode) + " sets it; remove it, or set 'exposure: auto'");
  }
}

}  // namespace

const Options<V4l2Config>& v4l2_options() {
  using V = V4l2Config;
  static const Options<V> table{
      option<&V::left>(
          {.key = "left",
           .format = kDevice,
           .accepts = is_device,
           .description =
               "Left camera. A port name (by-path) stays valid when the camera is plugged in again. auto takes both "
               "cameras in the order of their USB ports; set it for both or for none."}),
      option<&V::right>(
          {.key = "right", .format = "as for left", .accepts = is_device, .description = "Right camera."}),
      option<&V::width>({.key = "width",
                         .unit = "px",
                         .minimum = 64,
                         .maximum = kMaxImageSide,
                         .description = "Width of both cameras' images."}),
      option<&V::height>({.key = "height",
                          .unit = "px",
                          .minimum = 48,
                          .maximum = kMaxImageSide,
                          .description = "Height of both cameras' images."}),
      option<&V::format>(
          {.key = "format",
           .type = OptionInfo::Type::kChoice,
           .names = {"auto", "gray", "nv12", "yu12", "yuyv", "uyvy", "y10", "y16", "mjpeg"},
           .description =
               "Pixel format. auto tries an uncompressed format, then mjpeg, then a lower frame rate, until the bus "
               "has enough bandwidth; libv4l2 converts a format that stereod cannot read."}),
      choice<kExposureNames, &V::exposure>(
          {.key = "exposure",
           .description =
               "Control of the exposure. auto: each camera controls its own exposure. follow (recommended): stereod "
               "copies exposure time and gain of the left camera to the right camera. lock: as follow for 2 s, then "
               "both values are fixed."}),
      option<&V::controls>(
          {.key = "controls",
           .format = kControls,
           .description =
               "Controls of both cameras by name, such as {power_line_frequency: 1, gain: 20}. Automatic modes that "
               "would override a value are switched off; follow and lock do not change an exposure_time_absolute or "
               "a gain that is set here."}),
      option<&V::left_controls>(
          {.key = "left_controls",
           .format = kControls,
           .description = "Controls of the left camera only, in addition to controls."}),
      option<&V::right_controls>(
          {.key = "right_controls",
           .format = kControls,
           .description = "Controls of the right camera only, in addition to controls."}),
      choice<kSyncNames, &V::sync>(
          {.key = "sync",
           .description =
               "stereod restarts the camera that started last until both cameras expose at the same time (within "
               "max_sync_skew_ms). start: once, after both cameras stream. always: again when the difference "
               "exceeds 2 × max_sync_skew_ms. none: never."}),
      option<&V::max_sync_skew_ms>(
          {.key = "max_sync_skew_ms",
           .unit = "ms",
           .minimum = 0.1,
           .maximum = 100,
           .description = "Maximum time between both exposures at which sync stops restarting."}),
      option<&V::sync_attempts>({.key = "sync_attempts",
                                 .minimum = 1,
                                 .maximum = 100,
                                 .description = "Maximum number of restarts by sync."}),
  };
  return table;
}

void read_v4l2_section(YamlSection& cameras_section, CamerasConfig& cameras) {
  YamlSection section = cameras_section.section("v4l2");
  V4l2Config& v4l2 = cameras.v4l2;
  section.read(v4l2_options(), v4l2);
  check_devices(section, v4l2);
  check_modes(section, v4l2.controls, v4l2.exposure);
  check_own_controls(section, "left_controls", v4l2.left_controls, v4l2.exposure);
  check_own_controls(section, "right_controls", v4l2.right_controls, v4l2.exposure);
  section.finish();
  if (cameras.source == SourceKind::kV4l2 && cameras.fps < 1) {
    cameras_section.fail("fps", "found " + significant(cameras.fps) + ", allowed for source v4l2 1…240");
  }
}

}  // namespace stereod
