// SPDX-License-Identifier: BSD-3-Clause
// Compares the rectification table with the two OpenCV functions that it replaces.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "core/rectify/rectify_map.h"

namespace stereod {
namespace {

struct Maps {
  cv::Mat x, y;
};

Maps opencv_maps(const CameraCalibration& c, int type) {
  const CameraModel& m = c.camera;
  const RectifiedProjection& p = c.projection;
  const cv::Mat camera = (cv::Mat_<double>(3, 3) << m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1);
  const cv::Mat lens(distortion_of(m), true);
  const cv::Mat projection = (cv::Mat_<double>(3, 3) << p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1);
  const cv::Matx33d rotation(c.rotation.m.data());
  Maps maps;
  const cv::Size size(m.image.width, m.image.height);
  if (m.lens == LensModel::kFisheye) {
    cv::fisheye::initUndistortRectifyMap(camera, lens, rotation, projection, size, type, maps.x, maps.y);
  } else {
    cv::initUndistortRectifyMap(camera, lens, rotation, projection, size, type, maps.x, maps.y);
  }
  return maps;
}

// Returns cameras of every distortion model, each turned at random by up to a few degrees.
std::vector<CameraCalibration> cameras() {
  std::mt19937 random(20240611);
  const auto within = [&](double reach) {
    return reach * (2 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1);
  };
  using Lens = std::vector<double>;
  const Lens lenses[] = {
      {0, 0, 0, 0},                                         // none
      {-0.28, 0.09, 0, 0},                                  // barrel
      {0.12, 0.03, 0.001, -0.002},                          // pincushion, off center
      {-0.35, 0.14, 0.0006, -0.0004, -0.02},                // five coefficients
      {5.1, 2.2, -0.001, 0.002, 0.1, 5.4, 3.6, 0.4},        // rational
      {-0.1, 0.02, -0.004, 0.005, 0.01, 0.2, -0.05, 0.03},  // rational, off center
      {-0.2, 0.05, 0.001, -0.001, 0.01, 0.1, -0.05, 0.03, 0.01, -0.004, -0.006, 0.003},  // thin prism
      {-0.2, 0.05, 0.001, -0.001, 0.01, 0.1, -0.05, 0.03, 0.01, -0.004, -0.006, 0.003, 0.05, -0.08}  // tilted
  };
  const Lens fisheyes[] = {{0, 0, 0, 0}, {0.03, -0.01, 0.004, -0.001}, {-0.1, 0.02, 0, 0}};
  std::vector<CameraCalibration> result;
  for (const Size size : {Size{640, 480}, Size{321, 243}}) {
    const auto add = [&](const Lens& lens, LensModel model) {
      for (int turn = 0; turn < 4; ++turn) {
        CameraCalibration c;
        const double w = size.width, h = size.height;
        c.camera = {size, w * (0.85 + within(0.1)), w * (0.85 + within(0.1)), w / 2 + within(0.03 * w),
                    h / 2 + within(0.03 * h)};
        c.camera.lens = model;
        set_distortion(c.camera, lens);
        c.rotation = rotation_about({within(0.1), within(0.1), within(0.1)});
        const double f = w * (0.8 + within(0.1));
        c.projection = {f, f, w / 2 + within(0.05 * w), h / 2 + within(0.05 * h)};
        result.push_back(c);
      }
    };
    for (const Lens& lens : lenses) add(lens, LensModel::kPinhole);
    for (const Lens& lens : fisheyes) add(lens, LensModel::kFisheye);
  }
  return result;
}

TEST(RectifyOpenCv, SourceCoordinates_Equal) {
  for (const CameraCalibration& c : cameras()) {
    const Maps maps = opencv_maps(c, CV_32FC1);
    for (int y = 0; y < c.camera.image.height; ++y) {
      for (int x = 0; x < c.camera.image.width; ++x) {
        const auto found = source_point(c, {static_cast<double>(x), static_cast<double>(y)});
        ASSERT_TRUE(found.has_value());
        const Point2 own = *found;
        ASSERT_NEAR(own.x, maps.x.at<float>(y, x), 1e-3) << x << ' ' << y;
        ASSERT_NEAR(own.y, maps.y.at<float>(y, x), 1e-3) << x << ' ' << y;
      }
    }
  }
}

// Returns whether a coordinate is so close to a tie that single precision, which cv::remap uses, may round it
// to the other side.
bool close_to_a_tie(float coordinate, float margin = 1e-3F) {
  const float fraction = coordinate - std::floor(coordinate);
  return std::abs(fraction - 0.5F) < margin;
}

TEST(RectifyOpenCv, Nearest_EqualsRemap) {
  cv::RNG random(7);
  long compared = 0, outside = 0;
  for (const CameraCalibration& c : cameras()) {
    const Size size = c.camera.image;
    const Maps maps = opencv_maps(c, CV_32FC1);
    cv::Mat gray(size.height, size.width, CV_8UC1), color(size.height, size.width, CV_8UC3);
    random.fill(gray, cv::RNG::UNIFORM, 1, 256);
    random.fill(color, cv::RNG::UNIFORM, 1, 256);
    cv::Mat gray_want, color_want;
    cv::remap(gray, gray_want, maps.x, maps.y, cv::INTER_NEAREST);
    cv::remap(color, color_want, maps.x, maps.y, cv::INTER_NEAREST);

    GrayImage gray_out(size);
    ColorImage color_out(size);
    const RowRange all{0, size.height};
    RectifyMap(c, {size, static_cast<std::ptrdiff_t>(gray.step[0]), 1})
        .gray_rows(gray.data, all, gray_out.view());
    RectifyMap(c, {size, static_cast<std::ptrdiff_t>(color.step[0]), 3})
        .color_rows(color.data, all, color_out.view());
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        if (close_to_a_tie(maps.x.at<float>(y, x)) || close_to_a_tie(maps.y.at<float>(y, x))) continue;
        ++compared;
        outside += gray_out.at(x, y) == 0 ? 1 : 0;
        ASSERT_EQ(gray_out.at(x, y), gray_want.at<std::uint8_t>(y, x)) << x << ' ' << y;
        const auto want = color_want.at<cv::Vec3b>(y, x);
        ASSERT_EQ(color_out.at(x, y), (Rgb{want[0], want[1], want[2]})) << x << ' ' << y;
      }
    }
  }
  EXPECT_GT(compared, 8'000'000);  // ties are rare
  EXPECT_GT(outside, 100'000);     // some pixels lie outside the source
}

// Equal to the byte where all four neighbors lie in the image and rounding to 1/32 px is no tie.
TEST(RectifyOpenCv, Bilinear_EqualsRemap) {
  cv::RNG random(8);
  long compared = 0, inside = 0;
  for (const CameraCalibration& c : cameras()) {
    const Size size = c.camera.image;
    const Maps maps = opencv_maps(c, CV_32FC1);
    cv::Mat gray(size.height, size.width, CV_8UC1), want;
    random.fill(gray, cv::RNG::UNIFORM, 0, 256);
    cv::remap(gray, want, maps.x, maps.y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    const RectifyMap map(c, {size, static_cast<std::ptrdiff_t>(gray.step[0]), 1}, Interpolation::kBilinear);
    GrayImage out(size);
    map.gray_rows(gray.data, {0, size.height}, out.view());
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const float u = maps.x.at<float>(y, x), v = maps.y.at<float>(y, x);
        if (u < 0 || v < 0 || u > static_cast<float>(size.width - 1) ||
            v > static_cast<float>(size.height - 1)) {
          continue;
        }
        ++inside;
        ASSERT_GE(map.offset(x, y), 0) << x << ' ' << y;
        if (close_to_a_tie(32 * u, 0.01F) || close_to_a_tie(32 * v, 0.01F)) continue;
        ++compared;
        ASSERT_EQ(out.at(x, y), want.at<std::uint8_t>(y, x)) << x << ' ' << y;
      }
    }
  }
  EXPECT_GT(inside, 7'000'000);
  EXPECT_GT(compared, inside * 8 / 10);
}

TEST(RectifyOpenCv, Undistort_EqualsOpenCv) {
  for (const CameraCalibration& c : cameras()) {
    const CameraModel& m = c.camera;
    const cv::Mat camera = (cv::Mat_<double>(3, 3) << m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1);
    const cv::Mat lens(distortion_of(m), true);
    if (m.lens == LensModel::kFisheye) continue;  // OpenCV's result is not exact enough
    std::vector<cv::Point2d> pixels, want;
    for (double y = 0; y < m.image.height; y += 20) {
      for (double x = 0; x < m.image.width; x += 20) pixels.emplace_back(x, y);
    }
    cv::undistortPoints(pixels, want, camera, lens, cv::noArray(), cv::noArray(),
                        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-12));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto own = m.undistort(m.from_pixel({pixels[i].x, pixels[i].y}));
      ASSERT_TRUE(own.has_value());
      ASSERT_NEAR(own->x, want[i].x, 1e-6);
      ASSERT_NEAR(own->y, want[i].y, 1e-6);
    }
  }
}

}  // namespace
}  // namespace stereod
