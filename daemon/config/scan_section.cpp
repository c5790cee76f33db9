#include "daemon/config/scan_section.h"

#include <numbers>
#include <optional>

namespace stereod {
namespace {

constexpr double kRadians = std::numbers::pi / 180;  // in a degree

std::optional<bool> parse_ground(std::string_view name) {
  if (name == "fit") return true;
  if (name == "given") return false;
  return std::nullopt;
}

}  // namespace

void read_scan_section(YamlSection section, ScanConfig& scan) {
  scan.enabled = section.flag("enabled", scan.enabled);
  scan.fit_ground = section.choice<bool>("ground", scan.fit_ground, "fit and given", parse_ground);
  scan.ground.height_m = section.number("camera_height_m", scan.ground.height_m, 0.02, 5);
  scan.ground.pitch_rad =
      section.number("camera_pitch_deg", scan.ground.pitch_rad / kRadians, -45, 45) * kRadians;
  ScanOptions& options = scan.options;
  options.min_obstacle_height_m =
      section.number("min_obstacle_height_m", options.min_obstacle_height_m, 0.001, 2);
  options.max_obstacle_height_m =
      section.number("max_obstacle_height_m", options.max_obstacle_height_m, 0.002, 10);
  options.max_range_m = section.number("max_range_m", options.max_range_m, 0.1, 100);
  options.rays = section.integer("rays", options.rays, 1, 1024);
  options.min_support = section.integer("min_support", options.min_support, 1, 100'000);
  options.stop_distance_m = section.number("stop_distance_m", options.stop_distance_m, 0, 100);
  options.stop_width_m = section.number("stop_width_m", options.stop_width_m, 0.01, 10);
  if (options.max_obstacle_height_m <= options.min_obstacle_height_m) {
    section.fail("max_obstacle_height_m",
                 "is not above min_obstacle_height_m, so that nothing would be an obstacle");
  }
  section.finish();
}

}  // namespace stereod
