// SPDX-License-Identifier: BSD-3-Clause
// Poses and shading of the chessboard.
#include "daemon/capture/synthetic/synthetic_board.h"

#include <algorithm>
#include <cmath>

namespace stereod {

namespace {

constexpr double kBright = 215, kDark = 35;

// Returns +1 in even squares and −1 in odd ones, with a ramp of @p width squares between them.
double wave(double at, double width) {
  const double to_edge = at - std::round(at);
  const bool odd_edge = std::fmod(std::abs(std::round(at)), 2) == 1;
  const double ramp = std::clamp(to_edge / (width / 2), -1.0, 1.0);
  return odd_edge ? -ramp : ramp;
}

// Returns term @p number of a sequence that is evenly distributed over −1…1 at any length. With the three
// steps below, the triples are evenly distributed too (Roberts' R3 sequence, 2018).
double spread(int number, double step) {
  const double at = 0.5 + number * step;
  return 2 * (at - std::floor(at)) - 1;
}

}  // namespace

BoardPlace board_place(const BoardShape& shape, const Vector3& middle_m, const Vector3& turn) {
  const Matrix3 rotation = rotation_about(turn);
  const Vector3 to_middle =
      rotation * Vector3{(shape.columns - 1) * shape.square_m / 2, (shape.rows - 1) * shape.square_m / 2, 0};
  return {rotation, {middle_m.x - to_middle.x, middle_m.y - to_middle.y, middle_m.z - to_middle.z}};
}

std::vector<BoardPlace> varied_places(const BoardShape& shape, double half_width, double half_height,
                                      double baseline_m, int count) {
  const double width = shape.columns * shape.square_m, height = shape.rows * shape.square_m;
  // At this distance the tilted board fills three quarters of the image.
  const double nearest = std::max(0.725 * width / half_width, 0.58 * height / half_height);
  std::vector<BoardPlace> places;
  for (int i = 0; i < count; ++i) {
    const double z = nearest * (1 + 0.28 * ((i + i / 9) % 3));
    // A 3 × 3 grid over the image.
    const int column = i % 9 % 3 - 1, row = i % 9 / 3 - 1;
    const double free_x = std::max(0.0, half_width * z - (width + baseline_m) / 2);
    const double free_y = std::max(0.0, 0.89 * half_height * z - 0.6 * height);
    const Vector3 turn{0.4 * spread(i, 0.8191725), 0.4 * spread(i, 0.6710436), 0.12 * spread(i, 0.5497005)};
    places.push_back(board_place(shape, {column * free_x + 0.42 * baseline_m, row * free_y, z}, turn));
  }
  return places;
}

SyntheticBoard::SyntheticBoard(const BoardShape& shape, const BoardPlace& place, double focal_px)
    : shape_(shape), to_board_(transposed(place.rotation)), origin_m_(place.origin_m), focal_px_(focal_px) {}

SceneHit SyntheticBoard::hit(const SceneRay& ray, SceneHit behind) const {
  constexpr double kMinDepth = 0.05;  // [m] nearer points are not visible
  const Vector3 direction = to_board_ * Vector3{ray.x, ray.y, 1};
  const Vector3 origin = to_board_ * Vector3{origin_m_.x - ray.origin_x, origin_m_.y, origin_m_.z};
  const double depth = origin.z / direction.z;
  if (!(depth > kMinDepth && depth < behind.depth)) return behind;
  const double u = (direction.x * depth - origin.x) / shape_.square_m,
               v = (direction.y * depth - origin.y) / shape_.square_m;
  if (!(u > -2 && v > -2 && u < shape_.columns + 1 && v < shape_.rows + 1)) return behind;
  double brightness = kBright;
  if (u > -1 && v > -1 && u < shape_.columns && v < shape_.rows) {
    // Lens and pixels blur an edge over about two pixels.
    const double width = 2 * depth / focal_px_ / shape_.square_m;
    brightness = (kBright + kDark) / 2 - (kBright - kDark) / 2 * wave(u, width) * wave(v, width);
  }
  return {static_cast<float>(depth), static_cast<float>(brightness)};
}

}  // namespace stereod
