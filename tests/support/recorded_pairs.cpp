// SPDX-License-Identifier: BSD-3-Clause
// Rendering and writing recordings.
#include "tests/support/recorded_pairs.h"

#include <string>

#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/config/calibration_file.h"
#include "daemon/imagefile/write_image.h"

namespace stereod {
namespace {

std::string two_digits(int number) { return (number < 10 ? "0" : "") + std::to_string(number); }

}  // namespace

std::filesystem::path recorded_left(const std::filesystem::path& directory, int number) {
  return directory / ("left_" + two_digits(number) + ".png");
}

std::filesystem::path recorded_right(const std::filesystem::path& directory, int number) {
  return directory / ("right_" + two_digits(number) + ".png");
}

void write_recorded_pairs(const std::filesystem::path& directory, Size size, int count) {
  const SyntheticScene scene(size, count);
  for (int i = 0; i < count; ++i) {
    write_png(recorded_left(directory, i), scene.render_left(i).view());
    write_png(recorded_right(directory, i), scene.render_right(i).view());
  }
  write_calibration(directory / "calibration.yaml", scene.calibration());
}

}  // namespace stereod
