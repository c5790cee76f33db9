#include "tests/support/board_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tests/support/random_images.h"

namespace stereod {

namespace {

Vector3 plus(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

// +1 in even squares, −1 in odd ones, with a ramp `width` squares wide between them.
double wave(double at, double width) {
  const double to_edge = at - std::round(at);
  const bool odd_edge = std::fmod(std::abs(std::round(at)), 2) == 1;
  const double ramp = std::clamp(to_edge / (width / 2), -1.0, 1.0);
  return odd_edge ? -ramp : ramp;
}

}  // namespace

StereoCameras known_cameras(Size image, LensModel lens) {
  const double scale = image.width / 640.0;
  StereoCameras cameras;
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

BoardScene::BoardScene(const StereoCameras& cameras, const Board& board)
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

GreyImage BoardScene::render(const View& view, const BoardPose& pose, std::uint64_t noise_seed) const {
  Random random(noise_seed);
  GreyImage picture(view.camera.image);
  const Matrix3 back = transposed(pose.rotation);
  const Vector3 origin = back * pose.translation_m;  // minus the camera's place on the board
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      double grey = 90 + 20.0 * y / picture.height();
      const double ray_x = view.ray_x.at(x, y), ray_y = view.ray_y.at(x, y);
      const Vector3 ray = back * Vector3{ray_x, ray_y, 1};
      const double z = origin.z / ray.z;
      if (z > 0.05) {
        const double u = (ray.x * z - origin.x) / board_.square_m,
                     v = (ray.y * z - origin.y) / board_.square_m;
        // Lens and pixel smear an edge over about two pixels.
        const double width = 2 * z / view.camera.fx / board_.square_m;
        const bool on_board = u > -1 && v > -1 && u < board_.columns && v < board_.rows;
        const bool on_border = u > -2 && v > -2 && u < board_.columns + 1 && v < board_.rows + 1;
        if (on_board) {
          grey = 125 - 90 * wave(u, width) * wave(v, width);
        } else if (on_border) {
          grey = 215;
        }
      }
      grey += random.between(-3, 3);
      picture.at(x, y) = static_cast<std::uint8_t>(std::clamp(grey, 0.0, 255.0));
    }
  }
  return picture;
}

PicturePair BoardScene::render(const BoardPose& in_left, std::uint64_t noise_seed) const {
  return {"pair " + std::to_string(noise_seed), render(left_, in_left, 2 * noise_seed),
          render(right_, seen_from_right(cameras_.pose, in_left), 2 * noise_seed + 1)};
}

GreyImage copy_of(const GreyImage& picture) {
  GreyImage result(picture.size());
  copy_pixels(picture.view(), result.view());
  return result;
}

std::vector<PicturePair> copy_of(const std::vector<PicturePair>& pairs) {
  std::vector<PicturePair> result;
  for (const PicturePair& pair : pairs)
    result.push_back({pair.name, copy_of(pair.left), copy_of(pair.right)});
  return result;
}

BoardPose board_at(const Board& board, const Vector3& middle, const Vector3& turn) {
  BoardPose pose{rotation_about(turn), {}};
  const Vector3 centre{(board.columns - 1) * board.square_m / 2, (board.rows - 1) * board.square_m / 2, 0};
  const Vector3 turned = pose.rotation * centre;
  pose.translation_m = plus(middle, {-turned.x, -turned.y, -turned.z});
  return pose;
}

std::vector<BoardPose> varied_poses(const Board& board, int count) {
  Random random(11);
  const auto within = [&](double reach) { return reach * random.between(-1000, 1000) / 1000; };
  std::vector<BoardPose> poses;
  const double reach = std::max(board.columns, board.rows) * board.square_m;
  for (int i = 0; i < count; ++i) {
    const double z = reach * (1.45 + 0.4 * ((i + i / 9) % 3));
    // Round the image, and the middle.
    const int place = i % 9;
    const double free_x = std::max(0.0, 0.5 * z - 0.5 * board.columns * board.square_m - 0.03);
    const double free_y = std::max(0.0, 0.4 * z - 0.6 * board.rows * board.square_m);
    const Vector3 middle{(place % 3 - 1) * free_x + 0.025, (place / 3 - 1) * free_y, z};
    poses.push_back(board_at(board, middle, {within(0.4), within(0.4), within(0.12)}));
  }
  return poses;
}

}  // namespace stereod
