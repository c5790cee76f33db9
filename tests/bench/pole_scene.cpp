// SPDX-License-Identifier: BSD-3-Clause
// Rendering of poles before a wall.
#include "tests/bench/pole_scene.h"

#include <opencv2/imgproc.hpp>

namespace stereod::bench {
namespace {

cv::Mat1f texture(cv::RNG& random, cv::Size size) {
  cv::Mat1f noise(size), smooth, scaled;
  random.fill(noise, cv::RNG::UNIFORM, 0, 1);
  cv::GaussianBlur(noise, smooth, {}, 1.2);
  cv::Scalar mean, deviation;
  cv::meanStdDev(smooth, mean, deviation);
  constexpr double kMiddle = 128, kContrast = 35;
  smooth.convertTo(scaled, CV_32F, kContrast / deviation[0], kMiddle - kContrast * mean[0] / deviation[0]);
  return scaled;
}

}  // namespace

Poles poles(int width) {
  constexpr int kRows = 240, kColumns = 640, kNear = 40, kFar = 10, kFirst = 121, kStep = 59, kEnd = 600;
  cv::RNG random(3);
  const cv::Mat1f wall = texture(random, {kColumns + 64, kRows});
  cv::Mat1f left = wall(cv::Rect(0, 0, kColumns, kRows)).clone();
  cv::Mat1f right = wall(cv::Rect(kFar, 0, kColumns, kRows)).clone();
  Poles result{{}, cv::Mat1b(kRows, kColumns, std::uint8_t{0})};
  for (int x = kFirst; x < kEnd; x += kStep) {
    cv::Mat1f pole;
    texture(random, {width, kRows}).convertTo(pole, CV_32F, 0.6, 20);
    pole.copyTo(left(cv::Rect(x, 0, width, kRows)));
    pole.copyTo(right(cv::Rect(x - kNear, 0, width, kRows)));
    result.on_pole(cv::Rect(x, 0, width, kRows)) = 1;
  }
  constexpr double kNoise = 2;
  const auto camera = [&](const cv::Mat1f& image) {
    cv::Mat1f noise(image.size());
    cv::Mat seen;
    random.fill(noise, cv::RNG::NORMAL, 0, kNoise);
    cv::add(image, noise, seen, cv::noArray(), CV_8U);
    return seen;
  };
  result.set = {"poles", camera(left), camera(right), Image<float>(kColumns, kRows), 64};
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      result.set.truth.at(x, y) = static_cast<float>(result.on_pole(y, x) != 0 ? kNear : kFar);
    }
  }
  return result;
}

}  // namespace stereod::bench
