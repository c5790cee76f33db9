#include "daemon/config/config.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <thread>

#include "daemon/config/publish_section.h"
#include "daemon/config/scan_section.h"
#include "daemon/config/v4l2_section.h"
#include "daemon/config/yaml_section.h"

namespace stereod {
namespace {

constexpr int kMaxCpus = 1024;          // of the C library's sets of CPUs
constexpr std::size_t kMaxPrefix = 40;  // LCM's channel names have at most 63 characters

std::optional<SourceKind> parse_source_kind(std::string_view name) {
  if (name == "v4l2") return SourceKind::kV4l2;
  if (name == "replay") return SourceKind::kReplay;
  if (name == "synthetic") return SourceKind::kSynthetic;
  if (name == "log") return SourceKind::kLog;
  return std::nullopt;
}

void read_replay(YamlSection section, CamerasConfig& cameras) {
  cameras.replay_left = section.file_name("left");
  cameras.replay_right = section.file_name("right");
  cameras.replay_directory = section.file_name("directory");
  cameras.replay_loop = section.flag("loop", cameras.replay_loop);
  section.finish();
  const bool pair = !cameras.replay_left.empty() && !cameras.replay_right.empty();
  const bool half = cameras.replay_left.empty() != cameras.replay_right.empty();
  if (half || pair != cameras.replay_directory.empty()) {
    section.fail(
        "left", "found " +
                    std::string(half   ? "one of left and right"
                                : pair ? "both a pair and a directory"
                                       : "nothing to play") +
                    ", allowed are either left and right, two images, or directory, one with numbered pairs");
  }
}

void read_log(YamlSection section, CamerasConfig& cameras) {
  cameras.log_file = section.file_name("file");
  cameras.log_prefix = section.text("prefix", cameras.log_prefix);
  cameras.log_loop = section.flag("loop", cameras.log_loop);
  section.finish();
  if (cameras.log_file.empty()) section.fail("file", "found nothing, needed is the name of an LCM log");
}

std::optional<SceneKind> parse_scene_kind(std::string_view name) {
  if (name == "room") return SceneKind::kRoom;
  if (name == "board") return SceneKind::kBoard;
  return std::nullopt;
}

void read_synthetic(YamlSection section, CamerasConfig& cameras) {
  cameras.scene = section.choice<SceneKind>("scene", cameras.scene, "room and board", parse_scene_kind);
  cameras.width = section.integer("width", cameras.width, 64, 1920);
  cameras.height = section.integer("height", cameras.height, 48, 1200);
  cameras.skew_ms = section.number("skew_ms", cameras.skew_ms, -100, 100);
  section.finish();
}

void read_cameras(YamlSection section, CamerasConfig& cameras) {
  section.required_text("source");
  cameras.source = section.choice<SourceKind>("source", cameras.source, "v4l2, replay, synthetic and log",
                                              parse_source_kind);
  cameras.fps = section.number("fps", cameras.fps, 0, 240);
  cameras.max_skew_ms = section.number("max_skew_ms", cameras.max_skew_ms, 0, 1000);
  // A section for another source may stay in the file; it is checked all the same.
  read_v4l2_section(section, cameras);
  YamlSection replay = section.section("replay");
  YamlSection synthetic = section.section("synthetic");
  YamlSection log = section.section("log");
  if (cameras.source == SourceKind::kReplay || section.has("replay")) read_replay(std::move(replay), cameras);
  if (cameras.source == SourceKind::kLog || section.has("log")) read_log(std::move(log), cameras);
  read_synthetic(std::move(synthetic), cameras);
  section.finish();
}

void read_rectify(YamlSection section, RectifyConfig& rectify) {
  rectify.interpolation = section.choice<Interpolation>("interpolation", rectify.interpolation,
                                                        "nearest and bilinear", parse_interpolation);
  if (section.has("alpha")) rectify.alpha = section.number("alpha", 0, 0, 1);
  section.finish();
}

// Keys that the matcher chosen has no use for are more likely a mistake than a wish.
void refuse_keys_of_other_method(YamlSection& section, Method method) {
  const auto refuse = [&](const char* key, const char* owner) {
    if (section.has(key))
      section.fail(key, "belongs to method: " + std::string(owner) + ", which is not the one chosen");
  };
  if (method == Method::kSemiglobal) {
    for (const char* key : {"window", "texture_threshold", "cost", "cache"}) refuse(key, "block");
  } else {
    for (const char* key : {"grid", "p1", "p2", "census_weight", "gradient_limit", "hole_filling"}) {
      refuse(key, "semiglobal");
    }
  }
}

void read_semiglobal(YamlSection& section, MatcherOptions& options) {
  options.grid = section.choice<Grid>("grid", options.grid, "coarse and fine", parse_grid);
  options.p1 = section.integer("p1", options.p1, 0, 255);
  options.p2 = section.integer("p2", options.p2, 0, 255);
  options.census_weight = section.integer("census_weight", options.census_weight, 0, 16);
  options.gradient_limit = section.integer("gradient_limit", options.gradient_limit, 0, 64);
  options.hole_filling = section.flag("hole_filling", options.hole_filling);
}

void read_matcher(YamlSection section, MatcherOptions& options) {
  const std::string preset = section.text("preset", "robust");
  const auto chosen = matcher_preset(preset);
  if (!chosen) section.fail("preset", "found '" + preset + "', allowed are " + std::string(kMatcherPresets));
  options = *chosen;
  options.method = section.choice<Method>("method", options.method, "block and semiglobal", parse_method);
  refuse_keys_of_other_method(section, options.method);
  read_semiglobal(section, options);
  options.min_disparity = section.integer("min_disparity", options.min_disparity, 0, 1024);
  options.disparities = section.integer("disparities", options.disparities, 1, 256);
  options.window = section.integer("window", options.window, 3, 31);
  if (options.window % 2 == 0) {
    section.fail("window",
                 "found " + std::to_string(options.window) + ", allowed are odd numbers from 3 to 31");
  }
  options.cost = section.choice<Cost>("cost", options.cost, "sad, ssd and mad", parse_cost);
  options.prefilter =
      section.choice<Prefilter>("prefilter", options.prefilter, "none and xsobel", parse_prefilter);
  options.prefilter_cap = section.integer("prefilter_cap", options.prefilter_cap, 1, 63);
  // A preset without a prefilter to measure it on has no texture threshold.
  if (options.prefilter == Prefilter::kNone) options.texture_threshold = 0;
  options.texture_threshold = section.integer("texture_threshold", options.texture_threshold, 0, 100'000);
  options.uniqueness_ratio = section.integer("uniqueness_ratio", options.uniqueness_ratio, 0, 100);
  options.left_right_max_diff = section.integer("left_right_max_diff", options.left_right_max_diff, -1, 255);
  options.subpixel = section.flag("subpixel", options.subpixel);
  options.median = section.integer("median", options.median, 0, 5);
  options.speckle_size = section.integer("speckle_size", options.speckle_size, 0, 1'000'000);
  options.speckle_max_diff = section.integer("speckle_max_diff", options.speckle_max_diff, 0, 255);
  options.implementation = section.choice<Implementation>("implementation", options.implementation,
                                                          "naive, sliding and simd", parse_implementation);
  options.isa =
      section.choice<Isa>("isa", options.isa, "auto, scalar, ssse3, sse41, avx2 and neon", parse_isa);
  options.cache = section.choice<CacheUse>("cache", options.cache, "auto, large and small", parse_cache_use);
  section.finish();
  if (const auto problem = problem_with(options)) {  // what is left are combinations of keys
    section.fail(problem->substr(0, problem->find(' ')), *problem);
  }
}

// "0,2-3" as 0, 2, 3; nothing if it is no such list.
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

void read_scheduling(YamlSection section, SchedulingConfig& scheduling) {
  scheduling.priority = section.integer("priority", scheduling.priority, 0, 99);
  scheduling.cpus = section.choice<std::vector<int>>(
      "cpus", scheduling.cpus, "lists of CPUs by number from 0 to 1023, such as 2-3 or 0,2-3", parse_cpus);
  section.finish();
}

void read_lcm(YamlSection section, LcmConfig& lcm) {
  lcm.url = section.text("url", lcm.url);
  lcm.prefix = section.text("prefix", lcm.prefix);
  const bool plain = std::all_of(lcm.prefix.begin(), lcm.prefix.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  });
  if (lcm.prefix.empty() || lcm.prefix.size() > kMaxPrefix || !plain) {
    section.fail("prefix", "found '" + lcm.prefix + "', allowed are 1 to " + std::to_string(kMaxPrefix) +
                               " letters, digits, '_', '-' and '.'");
  }
  if (section.text("rows_per_message", "auto") != "auto") {
    lcm.rows_per_message = section.integer("rows_per_message", 0, 1, 4096);
  }
  lcm.pacing = section.number("pacing", lcm.pacing, 0, 0.9);
  lcm.raw_images = section.flag("raw_images", lcm.raw_images);
  lcm.raw_images_per_second = section.number("raw_images_per_second", lcm.raw_images_per_second, 0.1, 60);
  LeftImageConfig& left = lcm.left_image;
  const std::string form = section.text("left_image", "off");
  if (form != "off" && form != "jpeg" && form != "gray") {
    section.fail("left_image", "found '" + form + "', allowed are off, jpeg and gray");
  }
  left.enabled = form != "off";
  left.jpeg = form == "jpeg";
  left.per_second = section.number("left_images_per_second", left.per_second, 0.1, 240);
  section.finish();
}

std::string read_log_level(YamlSection section, const std::string& otherwise) {
  constexpr std::array<std::string_view, 4> kLevels{"debug", "info", "warning", "error"};
  std::string level =
      section.choice<std::string>("level", otherwise, "debug, info, warning and error",
                                  [&](std::string_view name) -> std::optional<std::string> {
                                    if (std::find(kLevels.begin(), kLevels.end(), name) == kLevels.end())
                                      return std::nullopt;
                                    return std::string(name);
                                  });
  section.finish();
  return level;
}

}  // namespace

std::string_view name_of(SourceKind kind) {
  switch (kind) {
    case SourceKind::kV4l2:
      return "v4l2";
    case SourceKind::kReplay:
      return "replay";
    case SourceKind::kSynthetic:
      return "synthetic";
    case SourceKind::kLog:
      return "log";
  }
  return "?";
}

std::int64_t CamerasConfig::pairing_tolerance_ns() const {
  if (max_skew_ms > 0) return static_cast<std::int64_t>(max_skew_ms * 1e6);
  const double rate = fps > 0 ? fps : 30;
  return static_cast<std::int64_t>(0.5e9 / rate);
}

int Config::worker_count() const {
  if (workers > 0) return workers;
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 64u));
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

Config read_config(const std::filesystem::path& file) {
  YamlSection root(file, load_yaml_map(file));
  Config config;
  read_cameras(root.required_section("cameras"), config.cameras);
  config.calibration = root.file_name("calibration");
  read_rectify(root.section("rectify"), config.rectify);
  read_matcher(root.section("matcher"), config.matcher);
  config.workers = root.integer("workers", config.workers, 0, 64);
  read_scheduling(root.section("scheduling"), config.scheduling);
  read_lcm(root.section("lcm"), config.lcm);
  read_publish_section(root.section("publish"), config.publish);
  read_scan_section(root.section("scan"), config.scan);
  config.log_level = read_log_level(root.section("log"), config.log_level);
  root.finish();
  return config;
}

}  // namespace stereod
