#include "daemon/config/v4l2_section.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace stereod {
namespace {

constexpr std::array<std::string_view, 9> kFormats{"auto", "gray", "nv12", "yu12", "yuyv",
                                                   "uyvy", "y10",  "y16",  "mjpeg"};

std::optional<std::string> parse_format(std::string_view name) {
  if (std::find(kFormats.begin(), kFormats.end(), name) == kFormats.end()) return std::nullopt;
  return std::string(name);
}

std::optional<ExposureMode> parse_exposure(std::string_view name) {
  if (name == "auto") return ExposureMode::kAuto;
  if (name == "lock") return ExposureMode::kLock;
  if (name == "follow") return ExposureMode::kFollow;
  return std::nullopt;
}

std::optional<SyncMode> parse_sync(std::string_view name) {
  if (name == "never") return SyncMode::kNone;
  if (name == "start") return SyncMode::kStart;
  if (name == "always") return SyncMode::kAlways;
  return std::nullopt;
}

std::string read_device(YamlSection& section, const std::string& key, const std::string& otherwise) {
  const std::string device = section.text(key, otherwise);
  if (device.empty() || device == "serial:") {
    section.fail(key, "found '" + device +
                          "', allowed are auto, a name below /dev/v4l/by-path or by-id, a node such as "
                          "/dev/video0, and serial:NUMBER; 'stereod --list-cameras' shows them");
  }
  // One node may be written in many ways: //dev/video0.
  return device.starts_with('/') ? std::filesystem::path(device).lexically_normal().string() : device;
}

// What lock and follow make equal is not set for one camera alone.
void check_own_controls(YamlSection& section, const std::string& key, const ControlValues& own,
                        ExposureMode mode) {
  constexpr std::array<std::string_view, 7> kExposure{
      "exposure_time_absolute", "exposure_absolute", "auto_exposure", "exposure_auto", "gain",
      "gain_automatic",         "autogain"};
  if (mode == ExposureMode::kAuto) return;
  for (const auto& [name, value] : own) {
    if (std::find(kExposure.begin(), kExposure.end(), name) == kExposure.end()) continue;
    const std::string modes = mode == ExposureMode::kLock ? "lock" : "follow";
    section.fail(key, "found " + name + " for one camera, but with 'exposure: " + modes +
                          "' both have the same; name it in 'controls' for both, or set 'exposure: auto'");
  }
}

// With lock and follow the daemon itself lets an automatic mode work, and switches it off.
void check_modes(YamlSection& section, const ControlValues& values, ExposureMode mode) {
  if (mode == ExposureMode::kAuto) return;
  for (const auto& [name, value] : values) {
    const bool exposure = name == "auto_exposure" || name == "exposure_auto";
    const bool gain = name == "gain_automatic" || name == "autogain";
    if (!(exposure && value != 1) && !(gain && value != 0)) continue;
    const std::string modes = mode == ExposureMode::kLock ? "lock" : "follow";
    section.fail("controls", "found " + name + ": " + std::to_string(value) +
                                 ", an automatic mode, but 'exposure: " + modes +
                                 "' sets it by itself; leave it out, or set 'exposure: auto'");
  }
}

}  // namespace

void read_v4l2_section(YamlSection& cameras_section, CamerasConfig& cameras) {
  YamlSection section = cameras_section.section("v4l2");
  V4l2Config& v4l2 = cameras.v4l2;
  v4l2.left = read_device(section, "left", v4l2.left);
  v4l2.right = read_device(section, "right", v4l2.right);
  if (v4l2.left == v4l2.right && v4l2.left != "auto") {
    section.fail("right", "found '" + v4l2.right + "', which is the left camera; name another one");
  }
  if ((v4l2.left == "auto") != (v4l2.right == "auto")) {
    section.fail(v4l2.left == "auto" ? "left" : "right",
                 "found 'auto' for one camera only, allowed is auto for both or a name for each");
  }
  v4l2.width = section.integer("width", v4l2.width, 64, 4096);
  v4l2.height = section.integer("height", v4l2.height, 48, 4096);
  v4l2.format = section.choice<std::string>(
      "format", v4l2.format, "auto, gray, nv12, yu12, yuyv, uyvy, y10, y16 and mjpeg", parse_format);
  v4l2.exposure =
      section.choice<ExposureMode>("exposure", v4l2.exposure, "auto, lock and follow", parse_exposure);
  v4l2.controls = section.integers("controls");
  v4l2.left_controls = section.integers("left_controls");
  v4l2.right_controls = section.integers("right_controls");
  check_modes(section, v4l2.controls, v4l2.exposure);
  check_own_controls(section, "left_controls", v4l2.left_controls, v4l2.exposure);
  check_own_controls(section, "right_controls", v4l2.right_controls, v4l2.exposure);
  v4l2.sync = section.choice<SyncMode>("sync", v4l2.sync, "never, start and always", parse_sync);
  v4l2.max_sync_skew_ms = section.number("max_sync_skew_ms", v4l2.max_sync_skew_ms, 0.1, 100);
  v4l2.sync_attempts = section.integer("sync_attempts", v4l2.sync_attempts, 1, 100);
  section.finish();
  if (cameras.source == SourceKind::kV4l2 && cameras.fps < 1) {
    cameras_section.fail("fps", "found a rate below 1, allowed for cameras are 1 to 240");
  }
}

}  // namespace stereod
