// SPDX-License-Identifier: BSD-3-Clause
// Rendering the scene and its ground truth.
#include "daemon/capture/synthetic/synthetic_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/base/text.h"
#include "core/base/worker_pool.h"
#include "core/geometry/depth.h"

namespace stereod {

namespace {

// Two cameras with the mounting errors of a home-made pair. The frame of reference is the rectified pair: its
// x axis is the baseline, its z axis the mean of the two optical axes (Fusiello, Trucco and Verri 2000). A
// camera's mounting error and its rectifying rotation are therefore the same matrix.
Calibration make_calibration(Size size, double baseline_m) {
  const double width = size.width, height = size.height;
  const double unit = std::max(width, height * 4 / 3);  // a narrow image is a crop of a wide one
  const double middle_x = (width - 1) / 2, middle_y = (height - 1) / 2;

  CameraCalibration left;
  left.camera = {size, 0.840 * unit, 0.842 * unit, middle_x + 0.008 * unit, middle_y - 0.006 * unit};
  left.camera.k1 = -0.28, left.camera.k2 = 0.09, left.camera.p1 = 0.0006, left.camera.p2 = -0.0004;
  left.rotation = rotation_about({0.006, -0.012, 0.010});

  CameraCalibration right;
  right.camera = {size, 0.853 * unit, 0.854 * unit, middle_x - 0.006 * unit, middle_y + 0.005 * unit};
  right.camera.k1 = -0.265, right.camera.k2 = 0.08, right.camera.p1 = -0.0003, right.camera.p2 = 0.0005;
  right.rotation = rotation_about({-0.005, 0.010, -0.008});

  // Shorter than the cameras' focal lengths, so that the rectified image shows nearly everything that both
  // cameras see and hardly any pixel outside their view.
  left.projection = {0.80 * unit, 0.80 * unit, middle_x, middle_y};
  right.projection = left.projection;

  Calibration calibration{size, left, right, baseline_m, "", {}};
  calibration.id = calibration_id(calibration);
  return calibration;
}

SourceLayout packed(Size size) { return {size, size.width, 1}; }

// SplitMix64 (Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

// Returns an approximately normal number with mean 0 and variance 1: the sum of four evenly distributed ones.
float normal(std::uint64_t random) {
  constexpr float kMean = 4 * 65535 / 2.0F;
  constexpr float kDeviation = 37837;
  const std::uint64_t sum =
      (random & 0xffff) + (random >> 16 & 0xffff) + (random >> 32 & 0xffff) + (random >> 48);
  return (static_cast<float>(sum) - kMean) / kDeviation;
}

}  // namespace

SyntheticScene::SyntheticScene(Size size, int frames, double baseline_m, bool boxes)
    : frames_(frames >= 1 ? frames
                          : throw std::invalid_argument("a scene has at least 1 frame, not " +
                                                        std::to_string(frames))),
      calibration_(make_calibration(size, baseline_m)),
      world_(calibration_.left.projection.fx, baseline_m, frames, boxes),
      left_(make_view(calibration_.left, 0, 1.0F, 0.0F, 1)),
      right_(make_view(calibration_.right, baseline_m, 0.86F, 8.0F, 2)) {}

SyntheticScene::View SyntheticScene::make_view(const CameraCalibration& calibration, double origin_x,
                                               float gain, float black_level,
                                               std::uint64_t noise_seed) const {
  const Size size = calibration.camera.image;
  if (size.width < 64 || size.height < 48) {
    throw std::invalid_argument("a scene is at least 64×48 pixels large, not " + to_string(size));
  }
  if (!(calibration_.baseline_m > 0)) throw std::invalid_argument("a scene's baseline is greater than 0 m");
  View view{static_cast<float>(origin_x),
            gain,
            black_level,
            noise_seed,
            RectifyMap(calibration, packed(size)),
            Image<Direction>(size),
            Image<SceneHit>(size)};
  WorkerPool pool(static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 4U)));
  pool.run(size.height, [&](int y, int) {
    for (int x = 0; x < size.width; ++x) {
      const CameraModel& camera = calibration.camera;
      const Point2 pixel{static_cast<double>(x), static_cast<double>(y)};
      const Point2 straight =
          camera.undistort(camera.from_pixel(pixel)).value();  // this lens has no foldover
      const Vector3 ray = calibration.rotation * Vector3{straight.x, straight.y, 1};
      view.rays.at(x, y) = {static_cast<float>(ray.x / ray.z), static_cast<float>(ray.y / ray.z)};
      view.still.at(x, y) = world_.still_hit({view.origin_x, view.rays.at(x, y).x, view.rays.at(x, y).y});
    }
  });
  return view;
}

GrayImage SyntheticScene::render(const View& view, int frame, const SyntheticBoard* board) const {
  constexpr float kNoise = 1.5F;  // standard deviation, gray levels
  GrayImage image(size());
  const SyntheticWorld::MovingBoxes moving = world_.moving_boxes(frame, view.origin_x);
  const auto phase = static_cast<std::uint64_t>(frame % frames_);
  std::uint64_t random = mixed((view.noise_seed << 32) + phase);
  for (int y = 0; y < image.height(); ++y) {
    const Direction* rays = view.rays.row(y);
    const SceneHit* still = view.still.row(y);
    std::uint8_t* out = image.row(y);
    for (int x = 0; x < image.width(); ++x) {
      const SceneRay ray{view.origin_x, rays[x].x, rays[x].y};
      SceneHit hit = moving.hit(ray, still[x]);
      if (board != nullptr) hit = board->hit(ray, hit);
      random += 0x9e3779b97f4a7c15;
      const float value = view.gain * hit.brightness + view.black_level + kNoise * normal(mixed(random));
      const float shifted = value + 0.5F;  // so that the conversion rounds to nearest
      out[x] = static_cast<std::uint8_t>(std::clamp(shifted, 0.0F, 255.0F));
    }
  }
  return image;
}

SceneRay SyntheticScene::rectified_ray(const View& view, float x, float y) const {
  const RectifiedProjection& p = calibration_.left.projection;  // the right one is the same
  return {view.origin_x, (x - static_cast<float>(p.cx)) / static_cast<float>(p.fx),
          (y - static_cast<float>(p.cy)) / static_cast<float>(p.fy)};
}

Image<float> SyntheticScene::ground_truth(int frame) const {
  Image<float> disparity(size());
  const SyntheticWorld::MovingBoxes moving = world_.moving_boxes(frame, left_.origin_x);
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) {
      const SceneRay ray = rectified_ray(left_, static_cast<float>(x), static_cast<float>(y));
      const float depth = moving.hit(ray, world_.still_hit(ray)).depth;
      const bool seen = left_.map.offset(x, y) >= 0;
      disparity.at(x, y) = seen ? static_cast<float>(disparity_at(calibration_, depth))
                                : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return disparity;
}

Image<std::uint8_t> SyntheticScene::visible_in_right(int frame) const {
  const Image<float> disparity = ground_truth(frame);
  const SyntheticWorld::MovingBoxes moving = world_.moving_boxes(frame, right_.origin_x);
  Image<std::uint8_t> visible(size());
  for (int y = 0; y < visible.height(); ++y) {
    for (int x = 0; x < visible.width(); ++x) {
      const float d = disparity.at(x, y);
      const float right_x = static_cast<float>(x) - d;
      if (!(right_x >= 0) || right_.map.offset(static_cast<int>(std::lround(right_x)), y) < 0)
        continue;  // or NaN
      const SceneRay ray = rectified_ray(right_, right_x, static_cast<float>(y));
      const float nearest = moving.hit(ray, world_.still_hit(ray)).depth;
      const auto own = static_cast<float>(depth_m(calibration_, d));
      visible.at(x, y) =
          nearest > own * 0.999F ? 1 : 0;  // an occluder is nearer by more than a rounding error
    }
  }
  return visible;
}

}  // namespace stereod
