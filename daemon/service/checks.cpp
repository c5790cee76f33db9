#include "daemon/service/checks.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/cpu.h"
#include "daemon/base/file_error.h"
#include "daemon/lcm/bus.h"
#include "daemon/lcm/limits.h"
#include "daemon/pipeline/pipeline.h"

namespace stereod {

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
    const bool too_large = std::max(size.width, size.height) > kMaxImageSide;
    const bool outside = region_problem(config.publish, size).has_value();
    throw FileError(place_of(file, too_large ? "cameras"
                                   : outside ? "publish.region"
                                             : "lcm.rows_per_message") +
                    ": " + error.what());
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
  const auto refuse = [&file](bool wanted, const char* key) {
    if (!wanted) return;
    throw FileError(
        place_of(file, key) +
        ": found true, but without a calibration no distance is known; give one, or allowed is false");
  };
  refuse(config.scan.enabled, "scan.enabled");
  refuse(config.publish.depth, "publish.depth");
  refuse(config.publish.cloud, "publish.cloud");
}

StereoSource open_checked_rig(const Config& config, const std::filesystem::path& file) {
  check_config(config, file);
  StereoSource rig = open_stereo_source(config);
  check_calibration(config, file, rig.calibration);
  check_frame_size(config, file, rig.left->frame_size());
  return rig;
}

}  // namespace stereod
