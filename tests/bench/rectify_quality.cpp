// SPDX-License-Identifier: BSD-3-Clause
// What the interpolation of rectification costs in depth: pairs with ground truth are given two lenses and
// two crooked cameras, rectified again either way, and matched.
//
// Both ways see the same distorted images, made by Lanczos interpolation, which the untouched images in
// the last column have not been through.
#include <cstdlib>
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/match/frame_matcher.h"
#include "core/rectify/rectify_map.h"
#include "daemon/tools/match/evaluation.h"
#include "tests/bench/bench_images.h"
#include "tests/bench/stereo_sets.h"
#include "tests/bench/tables.h"

namespace stereod::bench {

using tools::evaluate;
using tools::Evaluation;
namespace {

/// A webcam whose rectified image is the given one, except for a margin outside the view of the lens.
CameraCalibration webcam(Size size, bool left) {
  CameraCalibration calibration;
  CameraModel& camera = calibration.camera;
  const double unit = size.width;
  camera.image = size;
  camera.fx = camera.fy = (left ? 0.84 : 0.85) * unit;
  camera.cx = size.width / 2.0 + (left ? 5 : -4);
  camera.cy = size.height / 2.0 + (left ? -3 : 4);
  camera.k1 = left ? -0.27 : -0.26;
  camera.k2 = 0.09;
  camera.p1 = 0.001;
  camera.p2 = -0.0008;
  calibration.rotation =
      left ? rotation_about({0.006, -0.012, 0.010}) : rotation_about({-0.005, 0.010, -0.008});
  calibration.projection = {0.80 * unit, 0.80 * unit, (size.width - 1) / 2.0, (size.height - 1) / 2.0};
  return calibration;
}

/// Returns the camera image that belongs to the rectified image @p rectified.
cv::Mat seen_by(const CameraCalibration& camera, const cv::Mat& rectified) {
  cv::Mat map(rectified.size(), CV_32FC2);
  for (int y = 0; y < map.rows; ++y) {
    for (int x = 0; x < map.cols; ++x) {
      const auto p = rectified_point(camera, {static_cast<double>(x), static_cast<double>(y)});
      map.at<cv::Vec2f>(y, x) =
          p ? cv::Vec2f(static_cast<float>(p->x), static_cast<float>(p->y)) : cv::Vec2f(-10, -10);
    }
  }
  cv::Mat seen;
  cv::remap(rectified, seen, map, cv::noArray(), cv::INTER_LANCZOS4, cv::BORDER_REPLICATE);
  return seen;
}

struct Rectified {
  GrayImage image;
  ValidityMask mask;
};

Rectified rectified(const CameraCalibration& camera, const cv::Mat& seen, Interpolation interpolation) {
  const Size size{seen.cols, seen.rows};
  const RectifyMap map(camera, {size, static_cast<std::ptrdiff_t>(seen.step), 1}, interpolation);
  Rectified result{GrayImage(size), map.mask()};
  map.gray_rows(seen.data, {0, size.height}, result.image.view());
  return result;
}

struct Sum {
  double all = 0, matched = 0, density = 0;
  void add(const Evaluation& e) { all += e.bad1_known, matched += e.bad1_matched, density += e.density; }
};

std::string cell(const Sum& sum, std::size_t sets) {
  const auto one = [&](double value) {
    return std::to_string(value / static_cast<double>(sets)).substr(0, 4);
  };
  return one(sum.all) + " " + one(sum.matched) + " " + one(sum.density);
}

void measure() {
  const StereoSets sets = load_stereo_sets({});
  for (const std::string& missing : sets.missing) std::cout << missing << "\n";
  if (sets.sets.empty()) return;
  print_row("bad-1 all, bad-1 matched, matched; %", {"nearest", "bilinear", "untouched"});
  WorkerPool pool(1);
  for (const char* preset : {"thesis", "fast", "robust"}) {
    Sum sums[3];
    for (const StereoSet& set : sets.sets) {
      const Size size{set.left.cols, set.left.rows};
      MatcherOptions options = *matcher_preset(preset);
      options.disparities = set.disparities;
      FrameMatcher matcher(options, size, pool);
      DisparityImage found(size);
      const CameraCalibration left = webcam(size, true), right = webcam(size, false);
      const cv::Mat left_seen = seen_by(left, set.left), right_seen = seen_by(right, set.right);
      for (const Interpolation interpolation : {Interpolation::kNearest, Interpolation::kBilinear}) {
        const Rectified l = rectified(left, left_seen, interpolation);
        const Rectified r = rectified(right, right_seen, interpolation);
        matcher.use_masks(&l.mask, &r.mask);
        matcher.match(l.image.view(), r.image.view(), found.view());
        sums[interpolation == Interpolation::kNearest ? 0 : 1].add(
            evaluate(found.view(), options.units_per_pixel(), set.truth.view(), 1));
      }
      matcher.use_masks(nullptr, nullptr);
      matcher.match(view_of(set.left), view_of(set.right), found.view());
      sums[2].add(evaluate(found.view(), options.units_per_pixel(), set.truth.view(), 1));
    }
    print_row(
        std::string(preset) + ", mean over " + std::to_string(sets.sets.size()) + " sets",
        {cell(sums[0], sets.sets.size()), cell(sums[1], sets.sets.size()), cell(sums[2], sets.sets.size())});
  }
}

}  // namespace
}  // namespace stereod::bench

int main() {
  try {
    stereod::bench::measure();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "rectify_quality: " << error.what() << "\n";
    return 1;
  }
}
