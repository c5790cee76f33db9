// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/checks.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/cpu.h"
#include "daemon/base/file_error.h"
#include "daemon/lcm/bus.h"
#include "daemon/lcm/limits.h"
#include "daemon/pipeline/pipeline.h"

namespace stereod {
namespace {

/// Returns the key to change when check_pipeline() refuses frames of this size.
const char* key_of_size_problem(const Config& config, Size size) {
  if (std::max(size.width, size.height) > kMaxImageSide) return "cameras";
  if (region_problem(config.publish, size)) return "publish.region";
  return "lcm.rows_per_message";
}

}  // namespace

void check_config(const Config& config, const std::filesystem::path& file) {
  if (const auto problem = problem_for_daemon(config)) {
    throw FileError(place_of(file, problem->key) + ": " + problem->message);
  }
  try {
    url_to_publish(config.lcm.url);
  } catch (const BusError& error) {
    throw FileError(place_of(file, "lcm.url") + ": " + error.what());
  }
  try {
    resolve_isa(config.matcher.isa);
  } catch (const std::invalid_argument& error) {
    throw FileError(place_of(file, "matcher.isa") + ": " + error.what());
  }
}

void check_frame_size(const Config& config, const std::filesystem::path& file, Size size) {
  try {
    check_pipeline(config, size);
  } catch (const std::invalid_argument& error) {
    throw FileError(place_of(file, key_of_size_problem(config, size)) + ": " + error.what());
  }
}

void check_calibration(const Config& config, const std::filesystem::path& file,
                       const std::optional<Calibration>& calibration) {
  if (calibration) {
    if (const auto problem = problem_with_view(*calibration)) {
      throw FileError(place_of(file, "calibration") + ": " + config.calibration.string() + ": " + *problem);
    }
    return;
  }
  const auto refuse = [&file](bool enabled, const char* key) {
    if (!enabled) return;
    throw FileError(place_of(file, key) +
                    ": found true, allowed without a calibration is false: distances are not known; set "
                    "'calibration'");
  };
  refuse(config.scan.enabled, "scan.enabled");
  refuse(config.publish.depth, "publish.depth");
  refuse(config.publish.cloud, "publish.cloud");
}

StereoSource open_checked_source(const Config& config, const std::filesystem::path& file) {
  check_config(config, file);
  StereoSource source = open_stereo_source(config);
  check_calibration(config, file, source.calibration);
  check_frame_size(config, file, source.left->frame_size());
  return source;
}

}  // namespace stereod
