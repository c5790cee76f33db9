// SPDX-License-Identifier: BSD-3-Clause
// The thesis' tables of remapping.
#include <iostream>
#include <limits>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/rectify/rectify_map.h"
#include "tests/bench/bench_images.h"
#include "tests/bench/bench_thesis.h"
#include "tests/bench/interleaved.h"
#include "tests/bench/tables.h"
#include "tests/bench/webcam_calibration.h"

namespace stereod::bench {
namespace {

struct CvMaps {
  cv::Mat x, y;            // 32-bit floats, as the thesis used them
  cv::Mat fixed, nothing;  // 16-bit pairs, cv::remap's fastest format
};

CvMaps cv_maps(const CameraCalibration& c) {
  const CameraModel& m = c.camera;
  const cv::Mat camera = (cv::Mat_<double>(3, 3) << m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1);
  const cv::Mat lens = (cv::Mat_<double>(1, 5) << m.k1, m.k2, m.p1, m.p2, m.k3);
  const cv::Mat rotation = cv::Mat(3, 3, CV_64F, const_cast<double*>(c.rotation.m.data())).clone();
  const auto& p = c.projection;
  const cv::Mat projection = (cv::Mat_<double>(3, 3) << p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1);
  CvMaps maps;
  cv::initUndistortRectifyMap(camera, lens, rotation, projection, {m.image.width, m.image.height}, CV_32FC1,
                              maps.x, maps.y);
  cv::convertMaps(maps.x, maps.y, maps.fixed, maps.nothing, CV_16SC2, true);
  return maps;
}

void remap_table(const std::string& title, const cv::Mat& source, int rounds,
                 const std::vector<std::vector<double>>& thesis) {
  const int channels = source.channels();
  const Size size{source.cols, source.rows};
  const CameraCalibration calibration = webcam_calibration(size);
  const CvMaps maps = cv_maps(calibration);
  const RectifyMap map(calibration, {size, static_cast<std::ptrdiff_t>(source.step), channels});

  cv::Mat by_opencv, by_fixed;
  cv::Mat by_us(source.size(), source.type());
  const auto step = static_cast<std::ptrdiff_t>(by_us.step);
  const auto remap_own = [&](WorkerPool& pool) {
    if (channels == 1) {
      rectify_gray(map, source.data, {by_us.data, size.width, size.height, step}, pool);
    } else {
      rectify_color(map, source.data, {reinterpret_cast<Rgb*>(by_us.data), size.width, size.height, step},
                    pool);
    }
  };

  InterleavedRun run;
  const std::string opencv = "OpenCV remap";
  const std::string opencv_fixed = "same, 16SC2 map";
  run.add(opencv, [&] { cv::remap(source, by_opencv, maps.x, maps.y, cv::INTER_NEAREST); });
  run.add(opencv_fixed, [&] { cv::remap(source, by_fixed, maps.fixed, maps.nothing, cv::INTER_NEAREST); });
  Cells contestants = {opencv, opencv_fixed};
  std::vector<std::unique_ptr<WorkerPool>> pools;
  for (const int workers : {1, 2, 4, 8, 16, 32}) {
    pools.push_back(std::make_unique<WorkerPool>(workers));
    contestants.push_back("OR " + std::to_string(workers) + (workers == 1 ? " thread" : " threads"));
    run.add(contestants.back(), [&remap_own, pool = pools.back().get()] { remap_own(*pool); });
  }
  const InterleavedResults results = run.run(rounds);

  std::cout << "\n";
  print_row(title, contestants);
  print_measured(results, contestants, opencv);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // the thesis has no such column
  const Cells machines = {"Q8200 2.33 GHz", "i7-720Q 1.6 GHz"};
  for (std::size_t i = 0; i < thesis.size(); ++i) {
    std::vector<double> values = thesis[i];
    values.insert(values.begin() + 1, kNone);
    print_thesis(machines[i], values);
  }
  cv::Mat different = by_opencv.reshape(1) != by_us.reshape(1);
  std::cout << "  bytes that differ from OpenCV's: " << cv::countNonZero(different) << " of "
            << different.total() << "\n";
}

}  // namespace

void measure_remapping(int rounds) {
  const std::optional<MatPair> aloe = load_aloe_vga();
  if (!aloe) {
    std::cout << "\nTables 4.2 and 4.3 skipped: no Aloe images; install the package opencv-doc.\n";
    return;
  }
  std::cout << "\nNearest-neighbor remapping of one 640x480 image. OpenCV on one thread.\n";
  remap_table("Table 4.2: 24-bit Color Remapping", aloe->left, rounds,
              {{2.29, 0.95, 0.42, 0.44, 0.48, 0.43, 0.41}, {4.81, 1.55, 0.79, 0.75, 0.41, 0.64, 0.66}});
  remap_table("Table 4.3: 8-bit Gray Remapping", gray_of(aloe->left), rounds,
              {{1.93, 0.43, 0.23, 0.13, 0.15, 0.14, 0.14}, {3.97, 1.08, 0.55, 0.28, 0.31, 0.62, 0.32}});
}

}  // namespace stereod::bench
