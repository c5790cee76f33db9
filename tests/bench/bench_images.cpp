// SPDX-License-Identifier: BSD-3-Clause
// Loading of the images to measure on.
#include "tests/bench/bench_images.h"

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace stereod::bench {
namespace {

constexpr const char* kAloe = "/usr/share/doc/opencv-doc/examples/data/aloe";

std::optional<MatPair> load(const std::string& left, const std::string& right, cv::ImreadModes mode) {
  MatPair pair{cv::imread(left, mode), cv::imread(right, mode)};
  if (pair.left.empty() || pair.right.empty()) return std::nullopt;
  return pair;
}

}  // namespace

std::filesystem::path datasets() {
  if (const char* set = std::getenv("STEREO_DATASETS")) return set;
  return std::filesystem::path(STEREOD_SOURCE_DIR) / ".." / "shared" / "datasets";
}

std::optional<MatPair> load_tsukuba() {
  const std::filesystem::path directory = datasets() / "mb2001_tsukuba";
  return load((directory / "left.png").string(), (directory / "right.png").string(), cv::IMREAD_GRAYSCALE);
}

std::optional<MatPair> load_aloe(cv::Size size) {
  std::optional<MatPair> pair =
      load(std::string(kAloe) + "L.jpg", std::string(kAloe) + "R.jpg", cv::IMREAD_COLOR);
  if (!pair) return std::nullopt;
  for (cv::Mat* mat : {&pair->left, &pair->right}) {
    cv::Mat resized;
    cv::resize(*mat, resized, size, 0, 0, cv::INTER_AREA);
    *mat = resized;
  }
  return pair;
}

std::optional<MatPair> load_aloe_vga() { return load_aloe({640, 480}); }

cv::Mat gray_of(const cv::Mat& color) {
  cv::Mat gray;
  cv::cvtColor(color, gray, cv::COLOR_BGR2GRAY);
  return gray;
}

GrayView view_of(const cv::Mat& mat) {
  return {mat.data, mat.cols, mat.rows, static_cast<std::ptrdiff_t>(mat.step)};
}

}  // namespace stereod::bench
