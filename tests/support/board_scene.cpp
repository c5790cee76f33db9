// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/board_scene.h"

#include <algorithm>
#include <limits>
#include <string>

#include "daemon/capture/synthetic/synthetic_board.h"
#include "tests/support/random_images.h"

namespace stereod::calib {

namespace {

BoardShape shape_of(const Board& board) { return {board.columns, board.rows, board.square_m}; }

}  // namespace

StereoRigEstimate known_cameras(Size image, LensModel lens) {
  const double scale = image.width / 640.0;
  StereoRigEstimate cameras;
  const double f = lens == LensModel::kFisheye ? 330 * scale : 560 * scale;
  cameras.left = {image, f, f * 1.002, 318.3 * scale, 243.1 * scale};
  cameras.right = {image, f * 1.01, f * 1.012, 325.7 * scale, 236.4 * scale};
  cameras.left.lens = cameras.right.lens = lens;
  if (lens == LensModel::kFisheye) {
    set_distortion(cameras.left, std::vector<double>{0.03, -0.012, 0.004, -0.001});
    set_distortion(cameras.right, std::vector<double>{0.028, -0.01, 0.003, -0.001});
  } else {
    set_distortion(cameras.left, std::vector<double>{-0.28, 0.09, 0.0006, -0.0004});
    set_distortion(cameras.right, std::vector<double>{-0.265, 0.08, -0.0003, 0.0005});
  }
  cameras.pose = {rotation_about({0.006, -0.015, 0.008}), {-0.06, 0.0007, -0.0009}};
  return cameras;
}

BoardScene::BoardScene(const StereoRigEstimate& cameras, const Board& board)
    : cameras_(cameras), board_(board), left_(make_view(cameras.left)), right_(make_view(cameras.right)) {}

BoardScene::View BoardScene::make_view(const CameraModel& camera) {
  View view{camera, Image<float>(camera.image), Image<float>(camera.image)};
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  for (int y = 0; y < camera.image.height; ++y) {
    for (int x = 0; x < camera.image.width; ++x) {
      const auto ray = camera.undistort(camera.from_pixel({static_cast<double>(x), static_cast<double>(y)}));
      view.ray_x.at(x, y) = ray ? static_cast<float>(ray->x) : kNothing;
      view.ray_y.at(x, y) = ray ? static_cast<float>(ray->y) : kNothing;
    }
  }
  return view;
}

GrayImage BoardScene::render(const View& view, const BoardPose& pose, std::uint64_t noise_seed) const {
  Random random(noise_seed);
  GrayImage image(view.camera.image);
  const SyntheticBoard board(shape_of(board_), {pose.rotation, pose.translation_m}, view.camera.fx);
  for (int y = 0; y < image.height(); ++y) {
    SceneHit ground;  // at infinity
    ground.brightness = 90 + 20 * static_cast<float>(y) / static_cast<float>(image.height());
    for (int x = 0; x < image.width(); ++x) {
      const double gray = board.hit({0, view.ray_x.at(x, y), view.ray_y.at(x, y)}, ground).brightness;
      image.at(x, y) = static_cast<std::uint8_t>(std::clamp(gray + random.between(-3, 3), 0.0, 255.0));
    }
  }
  return image;
}

ImagePair BoardScene::render(const BoardPose& in_left, std::uint64_t noise_seed) const {
  return {"pair " + std::to_string(noise_seed), render(left_, in_left, 2 * noise_seed),
          render(right_, seen_from_right(cameras_.pose, in_left), 2 * noise_seed + 1)};
}

GrayImage copy_of(const GrayImage& image) {
  GrayImage result(image.size());
  copy_pixels(image.view(), result.view());
  return result;
}

std::vector<ImagePair> copy_of(const std::vector<ImagePair>& pairs) {
  std::vector<ImagePair> result;
  for (const ImagePair& pair : pairs) result.push_back({pair.name, copy_of(pair.left), copy_of(pair.right)});
  return result;
}

BoardPose board_at(const Board& board, const Vector3& middle, const Vector3& turn) {
  const BoardPlace place = board_place(shape_of(board), middle, turn);
  return {place.rotation, place.origin_m};
}

std::vector<BoardPose> varied_poses(const Board& board, int count) {
  std::vector<BoardPose> poses;
  for (const BoardPlace& place : varied_places(shape_of(board), 0.5, 0.45, 0.06, count)) {
    poses.push_back({place.rotation, place.origin_m});
  }
  return poses;
}

Corners projected_corners(const CameraModel& camera, const Board& board, const BoardPose& pose) {
  Corners corners;
  for (std::size_t i = 0; i < board.corner_count(); ++i) {
    const Vector3 p = pose.rotation * board_point(board, i);
    const double z = p.z + pose.translation_m.z;
    corners.push_back(camera.to_pixel(
        camera.distort({(p.x + pose.translation_m.x) / z, (p.y + pose.translation_m.y) / z})));
  }
  return corners;
}

}  // namespace stereod::calib
