// SPDX-License-Identifier: BSD-3-Clause
// Rectification beside OpenCV's: the table of runs and cv::remap on one image of 640×480.
#include <cstdlib>
#include <iostream>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/base/cpu.h"
#include "core/rectify/rectify_map.h"
#include "tests/bench/bench_images.h"
#include "tests/bench/interleaved.h"
#include "tests/bench/tables.h"
#include "tests/bench/webcam_calibration.h"

namespace stereod::bench {
namespace {

// Images in a row: enough that waking the workers, which may take milliseconds on a busy machine, hardly
// counts.
constexpr int kBatch = 400;

struct CvMaps {
  cv::Mat x, y;             // 32-bit floats
  cv::Mat fixed, fraction;  // 16-bit pairs, cv::remap's fastest format
};

CvMaps cv_maps(const CameraCalibration& c, Interpolation interpolation) {
  const CameraModel& m = c.camera;
  const cv::Mat camera = (cv::Mat_<double>(3, 3) << m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1);
  const cv::Mat lens = (cv::Mat_<double>(1, 5) << m.k1, m.k2, m.p1, m.p2, m.k3);
  const cv::Matx33d rotation(c.rotation.m.data());
  const auto& p = c.projection;
  const cv::Mat projection = (cv::Mat_<double>(3, 3) << p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1);
  CvMaps maps;
  cv::initUndistortRectifyMap(camera, lens, rotation, projection, {m.image.width, m.image.height}, CV_32FC1,
                              maps.x, maps.y);
  cv::convertMaps(maps.x, maps.y, maps.fixed, maps.fraction, CV_16SC2,
                  interpolation == Interpolation::kNearest);
  return maps;
}

struct Task {
  std::string name;
  cv::Mat source;
  Interpolation interpolation;
  double wanted_one, wanted_two;  // times as fast as cv::remap on one thread, as one thread on two
};

void rectify(const RectifyMap& map, const cv::Mat& source, cv::Mat& out, RowRange rows) {
  const Size size = map.size();
  const auto step = static_cast<std::ptrdiff_t>(out.step);
  if (source.channels() == 1) {
    map.gray_rows(source.data, rows, {out.data, size.width, size.height, step});
  } else {
    map.color_rows(source.data, rows, {reinterpret_cast<Rgb*>(out.data), size.width, size.height, step});
  }
}

/// Rectifies kBatch images; each worker takes the same band of all of them. In the daemon, too, the workers
/// are already running when rows are to be rectified.
void rectify_batch(const RectifyMap& map, const cv::Mat& source, cv::Mat& out, WorkerPool& pool) {
  pool.run(pool.workers(), [&](int band, int) {
    for (int i = 0; i < kBatch; ++i) {
      rectify(map, source, out, band_rows(source.rows, band, pool.workers()));
    }
  });
}

void measure(const Task& task, int rounds) {
  const Size size{task.source.cols, task.source.rows};
  const CameraCalibration calibration = webcam_calibration(size);
  const CvMaps maps = cv_maps(calibration, task.interpolation);
  const int flag = task.interpolation == Interpolation::kNearest ? cv::INTER_NEAREST : cv::INTER_LINEAR;
  const RectifyMap map(calibration,
                       {size, static_cast<std::ptrdiff_t>(task.source.step), task.source.channels()},
                       task.interpolation);
  cv::Mat by_floats, by_fixed, by_us(task.source.size(), task.source.type());
  WorkerPool one(1), two(2);
  InterleavedRun run;
  run.add("floats", [&] { cv::remap(task.source, by_floats, maps.x, maps.y, flag); });
  run.add("fixed", [&] { cv::remap(task.source, by_fixed, maps.fixed, maps.fraction, flag); });
  run.add("ours", [&] { rectify(map, task.source, by_us, {0, size.height}); });
  run.add("batch 1", [&] { rectify_batch(map, task.source, by_us, one); });
  run.add("batch 2", [&] { rectify_batch(map, task.source, by_us, two); });
  const InterleavedResults results = run.run(rounds);

  print_row(task.name,
            {ms(results.of("floats").best), ms(results.of("fixed").best), ms(results.of("ours").best),
             times(results.ratio("floats", "ours")), times(results.ratio("fixed", "ours")),
             times(results.of("batch 1").best / results.of("batch 2").best),
             std::to_string(map.bytes() / 1000) + " kB"});
  print_row("  wanted", {"", "", "", times(task.wanted_one), times(task.wanted_one), times(task.wanted_two),
                         "at most 1300 kB"});
  cv::Mat difference;
  cv::absdiff(by_fixed.reshape(1), by_us.reshape(1), difference);
  std::cout << "  bytes that differ from cv::remap's: " << cv::countNonZero(difference) << " of "
            << difference.total() << "\n";
}

/// Measures a camera that delivers YUYV, two bytes a pixel.
void measure_packed(const cv::Mat& gray, int rounds) {
  const Size size{gray.cols, gray.rows};
  const cv::Mat parts[] = {gray, gray};
  cv::Mat packed;
  cv::merge(parts, 2, packed);
  InterleavedRun run;
  std::vector<RectifyMap> maps;
  for (const Interpolation interpolation : {Interpolation::kNearest, Interpolation::kBilinear}) {
    for (const int stride : {1, 2}) {
      maps.emplace_back(webcam_calibration(size), SourceLayout{size, size.width * stride, stride},
                        interpolation);
    }
  }
  GrayImage out(size);
  Cells headings, cells;
  for (const RectifyMap& map : maps) {
    const bool plain = map.layout().pixel_stride == 1;
    headings.push_back(std::string(plain ? "gray " : "YUYV ") + std::string(name_of(map.interpolation())));
    run.add(headings.back(), [&map, &out, source = plain ? gray.data : packed.data] {
      map.gray_rows(source, {0, map.size().height}, out.view());
    });
  }
  const InterleavedResults results = run.run(rounds);
  for (const std::string& name : headings) cells.push_back(ms(results.of(name).best));
  std::cout << "\n";
  print_row("", headings);
  print_row("one thread", cells);
}

void measure_all(int rounds) {
  const std::optional<MatPair> aloe = load_aloe_vga();
  if (!aloe) {
    std::cout << "No Aloe images; install the package opencv-doc.\n";
    return;
  }
  const cv::Mat gray = gray_of(aloe->left);
  print_row(
      "", {"remap floats", "remap 16SC2", "ours", "floats / ours", "16SC2 / ours", "1 / 2 threads", "table"});
  measure({"gray, nearest", gray, Interpolation::kNearest, 6, 1.8}, rounds);
  measure({"24-bit color, nearest", aloe->left, Interpolation::kNearest, 4, 1.8}, rounds);
  measure({"gray, bilinear", gray, Interpolation::kBilinear, 1.5, 1.8}, rounds);
  measure_packed(gray, rounds);
}

}  // namespace
}  // namespace stereod::bench

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 60;
  if (rounds < 1) {
    std::cerr << "usage: bench_rectify [rounds, at least 1]\n";
    return 2;
  }
  cv::setNumThreads(1);
  std::cout << "OpenCV " << CV_VERSION << " remap on one thread and ours, one image of 640x480, " << rounds
            << " rounds; bilinear with " << stereod::name_of(stereod::resolve_isa(stereod::Isa::kAuto))
            << ".\n";
  stereod::bench::measure_all(rounds);
  return 0;
}
