// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config/config.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <thread>

#include "core/base/limits.h"
#include "daemon/config/sections.h"
#include "daemon/config/yaml_section.h"

namespace stereod {
namespace {

constexpr int kMaxCpus = 1024;          // of the C library's sets of CPUs
constexpr std::size_t kMaxPrefix = 40;  // LCM's channel names have at most 63 characters
constexpr int kMaxWorkers = 64;

/// Returns 0, 2, 3 for "0,2-3", nothing if the text is not such a list.
std::optional<std::vector<int>> parse_cpus(std::string_view text) {
  std::vector<int> cpus;
  std::istringstream parts{std::string(text)};
  for (std::string part; std::getline(parts, part, ',');) {
    int first = 0, last = 0, length = 0;
    const auto whole = [&] { return static_cast<std::size_t>(length) == part.size(); };
    if (part.empty() || part.find_first_not_of("0123456789-") != part.npos || part.size() > 9)
      return std::nullopt;
    if (std::sscanf(part.c_str(), "%d%n", &first, &length) == 1 && whole()) {
      last = first;
    } else if (std::sscanf(part.c_str(), "%d-%d%n", &first, &last, &length) != 2 || !whole()) {
      return std::nullopt;
    }
    if (first < 0 || last < first || last >= kMaxCpus) return std::nullopt;
    for (int cpu = first; cpu <= last; ++cpu) cpus.push_back(cpu);
  }
  return cpus;
}

/// Returns the CPUs as a comma-separated list.
std::string cpus_text(const std::vector<int>& cpus) {
  std::string text;
  for (const int cpu : cpus) text += (text.empty() ? "" : ",") + std::to_string(cpu);
  return text;
}

bool is_prefix(std::string_view text) {
  return !text.empty() && text.size() <= kMaxPrefix &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                  c == '-' || c == '.';
         });
}

template <typename Settings>
void read_section(YamlSection section, const Options<Settings>& table, Settings& settings) {
  section.read(table, settings);
  section.finish();
}

Option<RectifyConfig> interpolation_option() {
  return {
      {.key = "interpolation",
       .type = OptionInfo::Type::kChoice,
       .names = {name_of(Interpolation::kBilinear), name_of(Interpolation::kNearest)},
       .description =
           "Value of a rectified pixel, from the four pixels around its source (bilinear) or the nearest one. "
           "nearest takes 25 % of the time of bilinear, but shifts rows by up to 0.5 px."},
      [](const RectifyConfig& rectify) { return OptionValue(std::string(name_of(rectify.interpolation))); },
      [](RectifyConfig& rectify, const OptionValue& value) {
        rectify.interpolation = parse_interpolation(std::get<std::string>(value)).value();
      }};
}

Option<SchedulingConfig> cpus_option() {
  return {{.key = "cpus",
           .format = "CPU numbers 0…1023, such as 2-3 or 0,2-3",
           .accepts = [](std::string_view text) { return parse_cpus(text).has_value(); },
           .default_name = "all",
           .description = "CPUs on which the matching threads run."},
          [](const SchedulingConfig& scheduling) { return OptionValue(cpus_text(scheduling.cpus)); },
          [](SchedulingConfig& scheduling, const OptionValue& value) {
            scheduling.cpus = parse_cpus(std::get<std::string>(value)).value();
          }};
}

Option<LcmConfig> left_image_option() {
  return {{.key = "left_image",
           .type = OptionInfo::Type::kChoice,
           .names = {"none", "jpeg", "gray"},
           .description =
               "Publishes the rectified left image as STEREO_LEFT (bot_core.image_t), for stereo-view and "
               "lcm-spy. jpeg takes one datagram at 640×480, gray (uncompressed) several."},
          [](const LcmConfig& lcm) {
            return OptionValue(std::string(!lcm.left_image.enabled ? "none"
                                           : lcm.left_image.jpeg   ? "jpeg"
                                                                   : "gray"));
          },
          [](LcmConfig& lcm, const OptionValue& value) {
            lcm.left_image.enabled = std::get<std::string>(value) != "none";
            lcm.left_image.jpeg = std::get<std::string>(value) == "jpeg";
          }};
}

}  // namespace

const Options<Config>& root_options() {
  static const Options<Config> table{
      option<&Config::calibration>(
          {.key = "calibration",
           .format = "file by stereo-calibrate",
           .example = "calibration.yaml",
           .description =
               "Calibration of the two cameras, relative to the directory of this file. Without it stereod does not "
               "rectify, so the images must already be rectified. source synthetic has a built-in calibration."}),
      option<&Config::workers>({.key = "workers",
                                .minimum = 0,
                                .maximum = kMaxWorkers,
                                .default_name = "one for each CPU",
                                .description = "Number of matching threads."}),
  };
  return table;
}

const Options<RectifyConfig>& rectify_options() {
  static const Options<RectifyConfig> table{
      interpolation_option(),
      option<&RectifyConfig::alpha>(
          {.key = "alpha",
           .minimum = 0,
           .maximum = 1,
           .default_name = "that of the calibration",
           .example = "0.5",
           .description =
               "Part of the image that rectification keeps. 0: only the area that both cameras see. 1: the whole "
               "image of both cameras, with empty margins that are not matched. stereo-calibrate writes 0."}),
  };
  return table;
}

const Options<SchedulingConfig>& scheduling_options() {
  static const Options<SchedulingConfig> table{
      option<&SchedulingConfig::priority>(
          {.key = "priority",
           .minimum = 0,
           .maximum = 99,
           .default_name = "normal scheduling",
           .description = "Real-time priority (SCHED_FIFO) of the matching threads."}),
      cpus_option(),
  };
  return table;
}

const Options<LcmConfig>& lcm_options() {
  using L = LcmConfig;
  static const Options<L> table{
      option<&L::url>(
          {.key = "url",
           .format = "LCM URL",
           .default_name = "LCM_DEFAULT_URL, or udpm://239.255.76.67:7667?ttl=0 (this machine only)",
           .description = "Network to publish on."}),
      option<&L::prefix>({.key = "prefix",
                          .format = "1…40 letters, digits, '_', '-', '.'",
                          .accepts = is_prefix,
                          .description = "First part of every channel name, such as STEREO_DISPARITY."}),
      option<&L::rows_per_message>(
          {.key = "rows_per_message",
           .minimum = 1,
           .maximum = kMaxImageSide,
           .unset_name = "auto",
           .default_name = "16, or as many as fit",
           .description =
               "Number of disparity rows in one message. A message holds at most 65243 bytes of row data."}),
      option<&L::pacing>(
          {.key = "pacing",
           .minimum = 0,
           .maximum = 0.9,
           .description =
               "Share of the frame period (up to 0.1 s) over which the rows of a frame are sent, so that the socket "
               "buffer of a receiver does not overflow. 0 sends rows as soon as they are matched; fps: 0 counts as "
               "30 Hz."}),
      option<&L::raw_images>(
          {.key = "raw_images",
           .description =
               "Publishes the cameras' images as STEREO_LEFT_RAW and STEREO_RIGHT_RAW (bot_core.image_t), for "
               "calibration. One image needs many datagrams; if one is lost, the image is lost. Use it on this "
               "machine only, or with large socket buffers."}),
      option<&L::raw_images_per_second>({.key = "raw_images_per_second",
                                         .unit = "Hz",
                                         .minimum = 0.1,
                                         .maximum = 60,
                                         .description = "Maximum rate of the raw images."}),
      left_image_option(),
      option<&L::left_image, &LeftImageConfig::per_second>(
          {.key = "left_images_per_second",
           .unit = "Hz",
           .minimum = 0.1,
           .maximum = 240,
           .description = "Maximum rate of the left image."}),
  };
  return table;
}

const Options<Config>& log_options() {
  static const Options<Config> table{
      option<&Config::log_level>({.key = "level",
                                  .type = OptionInfo::Type::kChoice,
                                  .names = {"debug", "info", "warning", "error"},
                                  .description = "Minimum severity of the messages that are logged."}),
  };
  return table;
}

std::int64_t CamerasConfig::pairing_tolerance_ns() const {
  if (max_skew_ms > 0) return static_cast<std::int64_t>(max_skew_ms * 1e6);
  const double rate = fps > 0 ? fps : 30;
  return static_cast<std::int64_t>(0.5e9 / rate);
}

int Config::worker_count() const {
  if (workers > 0) return workers;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxWorkers);
}

std::string place_of(const std::filesystem::path& file, const std::string& key) {
  YAML::Node node = load_yaml_map(file);
  int line = 0;
  std::istringstream words(key);
  for (std::string word; std::getline(words, word, '.') && node.IsMap();) {
    line = 0;
    YAML::Node below;
    for (const auto& entry : node) {
      if (entry.first.Scalar() != word) continue;
      line = entry.first.Mark().line + 1;
      below.reset(entry.second);
    }
    node.reset(below);
  }
  return file.string() + (line > 0 ? ":" + std::to_string(line) : "") + ": " + key;
}

std::optional<Problem> problem_for_daemon(const Config& config) {
  const MatcherOptions& matcher = config.matcher;
  if (matcher.method == Method::kSemiglobal && matcher.implementation == Implementation::kNaive) {
    return Problem{
        "matcher.implementation",
        "found naive with method semiglobal, allowed simd (naive takes seconds for each frame; it is for "
        "stereo-match and tests)"};
  }
  return std::nullopt;
}

Config read_config(const std::filesystem::path& file) {
  YamlSection root(file, load_yaml_map(file));
  Config config;
  root.read(root_options(), config);
  read_cameras_section(root.required_section("cameras"), config.cameras);
  read_section(root.section("rectify"), rectify_options(), config.rectify);
  read_matcher_section(root.section("matcher"), config.matcher);
  read_section(root.section("scheduling"), scheduling_options(), config.scheduling);
  read_section(root.section("lcm"), lcm_options(), config.lcm);
  read_publish_section(root.section("publish"), config.publish);
  read_scan_section(root.section("scan"), config.scan);
  read_section(root.section("log"), log_options(), config);
  root.finish();
  return config;
}

}  // namespace stereod
