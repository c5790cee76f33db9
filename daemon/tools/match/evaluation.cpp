// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/match/evaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "daemon/imagefile/pfm_file.h"
#include "daemon/imagefile/read_image.h"

namespace stereod::tools {

namespace {

/// Sums over the image.
struct Sums {
  long known = 0;
  long matched = 0;
  long matched_off_by_1 = 0;
  long matched_off_by_2 = 0;
  double absolute = 0;

  void add_matched(double error) {
    ++matched;
    if (error > 1) ++matched_off_by_1;
    if (error > 2) ++matched_off_by_2;
    absolute += error;
  }
};

double gray_value(double disparity, double gray_per_px) {
  return std::clamp(std::round(disparity * gray_per_px), 0.0, 255.0);
}

double ratio(double part, long whole) { return whole > 0 ? part / static_cast<double>(whole) : 0; }
double percent(long part, long whole) { return 100 * ratio(static_cast<double>(part), whole); }

}  // namespace

Evaluation evaluate(DisparityView disparity, int units_per_pixel, ImageView<const float> truth,
                    double gray_per_px) {
  if (disparity.size() != truth.size()) {
    throw std::invalid_argument("the disparity image and its ground truth differ in size");
  }
  Sums sums;
  double squared = 0;
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const double wanted = truth.at(x, y);
      const int value = disparity.at(x, y);
      if (!std::isfinite(wanted)) continue;
      const double found = value < 0 ? 0 : static_cast<double>(value) / units_per_pixel;
      const double gray_error = gray_value(found, gray_per_px) - gray_value(wanted, gray_per_px);
      ++sums.known;
      squared += gray_error * gray_error;
      if (value >= 0) sums.add_matched(std::abs(found - wanted));
    }
  }

  const long unmatched = sums.known - sums.matched;
  Evaluation result;
  result.known = sums.known;
  result.matched = sums.matched;
  result.density = percent(sums.matched, sums.known);
  result.bad1_known = percent(sums.matched_off_by_1 + unmatched, sums.known);
  result.bad2_known = percent(sums.matched_off_by_2 + unmatched, sums.known);
  result.bad1_matched = percent(sums.matched_off_by_1, sums.matched);
  result.bad2_matched = percent(sums.matched_off_by_2, sums.matched);
  result.mean_absolute_error = ratio(sums.absolute, sums.matched);
  result.mean_squared_difference = ratio(squared, sums.known);
  return result;
}

Image<float> read_ground_truth(const std::filesystem::path& path, double scale) {
  if (is_pfm(path)) return read_pfm(path);
  const Image<std::uint16_t> image = read_gray16(path);
  Image<float> truth(image.size());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const int value = image.at(x, y);
      truth.at(x, y) =
          value == 0 ? std::numeric_limits<float>::infinity() : static_cast<float>(value / scale);
    }
  }
  return truth;
}

}  // namespace stereod::tools
