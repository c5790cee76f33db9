// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/disparity_file.h"

#include <algorithm>
#include <limits>
#include <string>

#include "daemon/base/file_error.h"
#include "daemon/imagefile/pfm_file.h"
#include "daemon/imagefile/write_image.h"

namespace stereod {

namespace {

constexpr int kMaxKittiValue = 65535;

int kitti_value(std::int16_t disparity, int units_per_pixel) {
  if (disparity < 0) return 0;
  return std::max(disparity * 256 / units_per_pixel, 1);
}

}  // namespace

Image<float> disparity_in_pixels(DisparityView disparity, int units_per_pixel) {
  Image<float> pixels(disparity.size());
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) {
      const std::int16_t value = disparity.at(x, y);
      pixels.at(x, y) = value < 0 ? std::numeric_limits<float>::infinity()
                                  : static_cast<float>(value) / static_cast<float>(units_per_pixel);
    }
  }
  return pixels;
}

void write_disparity_pfm(const std::filesystem::path& path, DisparityView disparity, int units_per_pixel) {
  write_pfm(path, disparity_in_pixels(disparity, units_per_pixel).view());
}

void write_disparity_png(const std::filesystem::path& path, DisparityView disparity, int units_per_pixel) {
  Image<std::uint16_t> values(disparity.size());
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) {
      const int value = kitti_value(disparity.at(x, y), units_per_pixel);
      if (value > kMaxKittiValue) {
        throw FileError(path.string() + ": found a disparity of " + std::to_string(value / 256) +
                        " px; a KITTI PNG holds less than 256 px; write a .pfm file instead");
      }
      values.at(x, y) = static_cast<std::uint16_t>(value);
    }
  }
  write_png(path, values.view());
}

void check_disparity_file_name(const std::filesystem::path& path) {
  if (path.extension() == ".pfm" || path.extension() == ".png") return;
  throw FileError(path.string() + ": disparities are written to files named .pfm or .png, not '" +
                  path.extension().string() + "'");
}

void write_disparity(const std::filesystem::path& path, DisparityView disparity, int units_per_pixel) {
  check_disparity_file_name(path);
  if (path.extension() == ".pfm") {
    write_disparity_pfm(path, disparity, units_per_pixel);
  } else {
    write_disparity_png(path, disparity, units_per_pixel);
  }
}

}  // namespace stereod
