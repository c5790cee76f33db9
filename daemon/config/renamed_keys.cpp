// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config/renamed_keys.h"

#include <array>

namespace stereod {
namespace {

constexpr auto kKeys = std::to_array<RenamedKey>({
    {"cameras.replay.folder", "cameras.replay.directory"},
    {"cameras.v4l2.align", "cameras.v4l2.sync"},
    {"cameras.v4l2.target_skew_ms", "cameras.v4l2.max_sync_skew_ms"},
    {"cameras.v4l2.align_tries", "cameras.v4l2.sync_attempts"},
    {"rectify.zoom", "rectify.alpha"},
    {"matcher.fill", "matcher.hole_filling"},
    {"lcm.spread", "lcm.pacing"},
    {"publish.column_step", "publish.decimation_x"},
    {"publish.row_step", "publish.decimation_y"},
    {"publish.cloud_step", "publish.cloud_decimation"},
    {"scan.lowest_m", "scan.min_obstacle_height_m"},
    {"scan.highest_m", "scan.max_obstacle_height_m"},
});

constexpr auto kValues = std::to_array<RenamedValue>({
    {"cameras.v4l2.format", "grey", "gray"},
    {"cameras.v4l2.sync", "never", "none"},
    {"lcm.left_image", "grey", "gray"},
    {"lcm.left_image", "off", "none"},
    {"scan.ground", "fit", "estimate"},
    {"scan.ground", "given", "fixed"},
});

}  // namespace

std::span<const RenamedKey> renamed_keys() { return kKeys; }
std::span<const RenamedValue> renamed_values() { return kValues; }

std::string_view new_key(std::string_view old_key) {
  for (const RenamedKey& renamed : kKeys) {
    if (renamed.old_key == old_key) return renamed.new_key;
  }
  return {};
}

std::string_view new_value(std::string_view key, std::string_view old_value) {
  for (const RenamedValue& renamed : kValues) {
    if (renamed.key == key && renamed.old_value == old_value) return renamed.new_value;
  }
  return {};
}

}  // namespace stereod
