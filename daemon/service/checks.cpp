#include "daemon/service/checks.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include "core/match/isa.h"
#include "core/rectify_map.h"
#include "daemon/config/file_error.h"
#include "daemon/pipeline/pipeline.h"
#include "daemon/publish/lcm_bus.h"
#include "daemon/publish/wire_limits.h"

namespace stereod {

void check_config(const Config& config, const std::filesystem::path& file) {
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
    const bool too_large = std::max(size.width, size.height) > kLargestImageSide;
    const bool outside = region_problem(config.publish, size).has_value();
    throw FileError(place_of(file, too_large ? "cameras"
                                   : outside ? "publish.region"
                                             : "lcm.rows_per_message") +
                    ": " + error.what());
  }
}

namespace {

// Share of the rectified image's pixels that have a source in the camera's picture.
double share_seen(const CameraCalibration& camera, Size image) {
  const ValidityMask mask = RectifyMap(camera, {image, image.width, 1}).mask();
  std::int64_t seen = 0;
  for (int y = 0; y < image.height; ++y) seen += std::accumulate(mask.row(y), mask.row(y) + image.width, 0);
  return static_cast<double>(seen) / (static_cast<double>(image.width) * image.height);
}

// A file may be well-formed and its numbers those of no camera.
void check_sight(const Config& config, const std::filesystem::path& file, const Calibration& calibration) {
  constexpr double kLeast = 0.05;
  const double left = share_seen(calibration.left, calibration.image);
  const double right = share_seen(calibration.right, calibration.image);
  if (std::min(left, right) >= kLeast) return;
  char shares[80];
  std::snprintf(shares, sizeof shares, "%.1f %% of the left rectified picture and %.1f %% of the right one",
                100 * left, 100 * right);
  throw FileError(place_of(file, "calibration") + ": " + config.calibration.string() + " leaves only " +
                  shares + " with anything in them; its numbers are those of no camera: calibrate again");
}

}  // namespace

void check_calibration(const Config& config, const std::filesystem::path& file,
                       const std::optional<Calibration>& calibration) {
  if (calibration) return check_sight(config, file, *calibration);
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

Rig open_checked_rig(const Config& config, const std::filesystem::path& file) {
  check_config(config, file);
  Rig rig = open_rig(config);
  check_calibration(config, file, rig.calibration);
  check_frame_size(config, file, rig.left->frame_size());
  return rig;
}

}  // namespace stereod
