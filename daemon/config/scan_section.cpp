// SPDX-License-Identifier: BSD-3-Clause
// Reads the section `scan`.
#include <array>
#include <numbers>
#include <string>

#include "core/base/text.h"
#include "daemon/config/sections.h"

namespace stereod {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr EnumNames<bool, 2> kGroundNames{{{true, "estimate"}, {false, "fixed"}}};

Option<ScanConfig> pitch_option() {
  return {{.key = "camera_pitch_deg",
           .type = OptionInfo::Type::kNumber,
           .unit = "deg",
           .minimum = -45,
           .maximum = 45,
           .only_with = "ground: fixed",
           .description = "Angle by which the camera looks down."},
          [](const ScanConfig& scan) { return OptionValue(scan.ground.pitch_rad / kRadiansPerDegree); },
          [](ScanConfig& scan, const OptionValue& value) {
            scan.ground.pitch_rad = std::get<double>(value) * kRadiansPerDegree;
          }};
}

}  // namespace

const Options<ScanConfig>& scan_options() {
  using S = ScanConfig;
  using O = ScanOptions;
  static const Options<S> table{
      option<&S::enabled>(
          {.key = "enabled",
           .description =
               "Publishes the nearest obstacle in each direction as STEREO_SCAN (bot_core.planar_lidar_t), "
               "once a frame. Needs a calibration."}),
      choice<kGroundNames, &S::fit_ground>(
          {.key = "ground",
           .description =
               "Position of the floor. estimate: stereod computes it from the disparities and updates it. fixed: "
               "camera_height_m and camera_pitch_deg give it."}),
      option<&S::ground, &GroundPlane::height_m>(
          {.key = "camera_height_m",
           .unit = "m",
           .minimum = 0.02,
           .maximum = 5,
           .only_with = "ground: fixed",
           .description = "Height of the left camera above the floor."}),
      pitch_option(),
      option<&S::options, &O::min_obstacle_height_m>(
          {.key = "min_obstacle_height_m",
           .unit = "m",
           .minimum = 0.001,
           .maximum = 2,
           .description = "The robot can drive over objects up to this height above the floor."}),
      option<&S::options, &O::max_obstacle_height_m>(
          {.key = "max_obstacle_height_m",
           .unit = "m",
           .minimum = 0.002,
           .maximum = 10,
           .description =
               "The robot can drive under objects above this height above the floor. Must be above "
               "min_obstacle_height_m."}),
      option<&S::options, &O::max_range_m>({.key = "max_range_m",
                                            .unit = "m",
                                            .minimum = 0.1,
                                            .maximum = 100,
                                            .description = "Maximum distance of obstacles."}),
      option<&S::options, &O::rays>(
          {.key = "rays", .minimum = 1, .maximum = 1024, .description = "Number of directions."}),
      option<&S::options, &O::min_support>(
          {.key = "min_support",
           .unit = "px",
           .minimum = 1,
           .maximum = 100'000,
           .description = "Minimum number of pixels of an obstacle in one direction."}),
      option<&S::options, &O::stop_distance_m>(
          {.key = "stop_distance_m",
           .unit = "m",
           .minimum = 0,
           .maximum = 100,
           .description =
               "stereod sets the flag stop of frame_t if an obstacle in the way ahead is nearer than this, if more "
               "than 25 % of the way ahead was not seen, or while the floor is not found. 0: stop is never set."}),
      option<&S::options, &O::stop_width_m>(
          {.key = "stop_width_m",
           .unit = "m",
           .minimum = 0.01,
           .maximum = 10,
           .description = "Width of the strip in front of the robot in which obstacles set the flag stop."}),
  };
  return table;
}

void read_scan_section(YamlSection section, ScanConfig& scan) {
  section.read(scan_options(), scan);
  if (scan.options.max_obstacle_height_m <= scan.options.min_obstacle_height_m) {
    section.fail("max_obstacle_height_m", "found " + significant(scan.options.max_obstacle_height_m) +
                                              ", allowed more than min_obstacle_height_m (" +
                                              significant(scan.options.min_obstacle_height_m) + ")");
  }
  section.finish();
}

}  // namespace stereod
